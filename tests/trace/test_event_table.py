"""Tables of events: parts of them, and one of several."""

import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from traces import chunks, random_trace, said, table

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.csv_format import HEADER
from amalthea_uros.trace.table import COLUMNS, Entity, EntityKind, EventKind, EventTable, concatenate

STIMULUS = [Entity(EntityKind.STIMULUS, "S")]


def triggers(*times):
    return table(STIMULUS, [(time, EventKind.TRIGGER, 0, number, 0, number) for number, time in enumerate(times)])


def test_a_window_has_its_start_and_not_its_end():
    assert triggers(0, 10, 20, 20, 30).between(10, 20).time.tolist() == [10]
    assert triggers(0, 10, 20, 20, 30).between(20, 31).time.tolist() == [20, 20, 30]
    assert len(triggers(0, 10).between(11, 20)) == 0


@given(st.randoms(use_true_random=False), st.integers(0, 10**8), st.integers(0, 10**8))
def test_a_window_is_what_filtering_gives(random, start, end):
    whole = random_trace(random)
    assert said(whole.between(start, end)) == [row for row in said(whole) if start <= row[0] < end]


@given(st.randoms(use_true_random=False), st.integers(1, 20))
def test_chunks_together_are_the_whole(random, size):
    whole = random_trace(random)
    assert said(concatenate(chunks(whole, size))) == said(whole)


def test_no_tables_have_no_entities():
    with pytest.raises(InvalidArgumentError, match="no tables"):
        concatenate([])


def test_columns_by_name_are_those_of_the_table():
    columns = triggers(5, 6).to_dict()
    assert list(columns) == ["time", "kind", "source", "source_instance", "target", "target_instance", "note"] == list(COLUMNS)
    assert columns["time"].dtype == np.int64
    assert columns["kind"].tolist() == [30, 30]


def test_a_data_frame_has_words_and_names():
    pytest.importorskip("pandas")
    entities = [*STIMULUS, Entity(EntityKind.TASK, "T"), Entity(EntityKind.OS_EVENT, "E")]
    rows = [(5, EventKind.ACTIVATE, 0, 1, 1, 2), (7, EventKind.SET_EVENT, 1, 2, 2, 0, 1), (9, EventKind.WRITE, 1, 2, 2, 0, -4)]
    frame = table(entities, rows).to_dataframe()
    assert list(frame.columns) == HEADER
    assert frame.to_numpy().tolist() == [
        [5, "activate", "STI", "S", 1, "T", "T", 2, None],
        [7, "set_event", "T", "T", 2, "EVENT", "E", 0, "T"],
        [9, "write", "T", "T", 2, "EVENT", "E", 0, -4],
    ]
    assert len(EventTable.empty(entities).to_dataframe()) == 0


def test_without_pandas_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pip install amuros\[pandas\]"):
        triggers(0).to_dataframe()
