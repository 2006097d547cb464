"""CSV files, which hold all that a table of events does."""

import csv
import io
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st
from traces import chunks, decoded, encoded, random_trace, said, table

from amalthea_uros._internal.csv_cells import original_text
from amalthea_uros.trace.sinks import open_sink
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

HEADER = "time_ps,event,source_kind,source,source_instance,target_kind,target,target_instance,note\n"
CORE, TASK, CHAIN = Entity(EntityKind.CORE, "Core"), Entity(EntityKind.TASK, 'A "b", c'), Entity(EntityKind.CHAIN, "Chain")
ROWS = [(5, EventKind.START, 0, 0, 1, 3), (6, EventKind.CHAIN_STEP, 1, 3, 2, 9, 0)]
TEXT = HEADER + '5,start,C,Core,0,T,"A ""b"", c",3,\n6,chain_step,T,"A ""b"", c",3,CHAIN,Chain,9,0\n'


@pytest.fixture
def read(tmp_path):
    return partial(decoded, tmp_path / "run.csv")


def test_the_form(read):
    trace = table([CORE, TASK, CHAIN], ROWS)
    assert encoded(".csv", trace).decode() == TEXT
    assert read(TEXT) == (said(trace), ())


@pytest.mark.parametrize(
    ("line", "rule"),
    [
        ("x,start,C,Core,0,T,A,3,", "TRC002"),
        ("6,begin,C,Core,0,T,A,3,", "TRC002"),
        ("6,start,Q,Core,0,T,A,3,", "TRC002"),
        ("6,start,C,Core,0,T,A,3", "TRC002"),
        ("6,start,C,Core,-1,T,A,3,", "TRC002"),
        (f"{2**63},start,C,Core,0,T,A,3,", "TRC002"),
        ("4,start,C,Core,0,T,A,3,", "TRC004"),
    ],
)
def test_a_wrong_line_is_reported_and_the_others_are_read(read, line, rule):
    rows, [finding] = read(HEADER + "5,start,C,Core,0,T,A,3,\n" + line + "\n9,terminate,C,Core,0,T,A,3,\n")
    # Nobody knows which event the line was, so there is a gap.
    assert [row[:2] for row in rows] == [(5, EventKind.START), (5, EventKind.GAP), (9, EventKind.TERMINATE)]
    assert (finding.rule, finding.location.line, finding.location.text) == (rule, 3, line)


def test_another_header(read):
    _, findings = read("time,event\n1,2\n")
    assert [finding.rule for finding in findings] == ["TRC005", "TRC002"]


# A carriage return in quotes is kept, a surrogate is no text.
names = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\x00"), min_size=1)


@given(
    random=st.randoms(use_true_random=False),
    names=st.lists(names, min_size=12, max_size=12, unique=True),
    size=st.integers(1, 40),
    suffix=st.sampled_from([".csv", ".csv.gz"]),
)
def test_what_is_written_is_read_again(tmp_path_factory, random, names, size, suffix):
    trace = random_trace(random, names=names)
    path = tmp_path_factory.mktemp("traces") / f"run{suffix}"
    with open_sink(path, trace.entities) as sink:
        for part in chunks(trace, size):
            sink.write(part)
    assert decoded(path, path.read_bytes()) == (said(trace), ())


@given(st.lists(names, min_size=12, max_size=12, unique=True), st.randoms(use_true_random=False))
def test_other_programs_read_the_same_names(names, random):
    trace = random_trace(random, names=names)
    rows = csv.DictReader(io.StringIO(encoded(".csv", trace).decode(), newline=""))
    # Except for names that a spreadsheet would take for a formula.
    assert [original_text(row["target"]) for row in rows] == [trace.entities[target].name for target in trace.target]
