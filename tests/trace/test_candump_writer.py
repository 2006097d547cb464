"""Traces written as a log of candump, with the file that says which identifier is which marker."""

import io
from random import Random

import pytest
import yaml
from can_frames import DATA, EXTENDED, US, rows
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT
from traces import random_trace, table

from amalthea_uros import simulate
from amalthea_uros.errors import WriteError
from amalthea_uros.trace.can.logs import open_can_log
from amalthea_uros.trace.sinks import open_sink
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

ENTITIES = [
    Entity(EntityKind.CORE, "Core"),
    Entity(EntityKind.TASK, "A"),
    Entity(EntityKind.ISR, "I"),
    Entity(EntityKind.LABEL, "L"),
]
ROWS = [
    (1_999_999, EventKind.ACTIVATE, 1, 0, 1, 7),
    (1_999_999, EventKind.START, 0, 0, 1, 7),
    (3_000_000, EventKind.WRITE, 1, 7, 3, 0),
    (61_000_000_000_000, EventKind.TERMINATE, 0, 0, 1, 7),
    (61_000_000_000_000, EventKind.START, 0, 0, 2, 2**32 + 1),
]


def write(path, entities=ENTITIES, events=ROWS):
    with open_sink(path, entities) as sink:
        sink.write(table(entities, events))


def test_the_form(tmp_path):
    write(tmp_path / "run.log")
    # Microseconds are rounded down; the number of the job starts again after 32 bits.
    assert (tmp_path / "run.log").read_text() == (
        "(0000000000.000001) can0 18000003#07000000\n"
        "(0000000061.000000) can0 18000004#07000000\n"
        "(0000000061.000000) can0 18000005#01000000\n"
    )
    assert yaml.safe_load((tmp_path / "run.log.markers.yaml").read_text()) == {
        name: {"start": start, "end": start + 1, "counter": "bytes 0..3", "kind": "process", "quantity": "gross_execution_time"}
        for name, start in (("A", 0x18000003), ("I", 0x18000005))
    }


def test_a_packed_log_has_its_markers_beside_it(tmp_path):
    write(tmp_path / "run.log.gz")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.log.gz", "run.log.markers.yaml"]


def test_a_stream_has_no_markers():
    stream = io.BytesIO()
    with open_sink(stream, ENTITIES, suffix=".log") as sink:
        sink.write(table(ENTITIES, ROWS))
    assert stream.getvalue().count(b"\n") == 3


def test_markers_that_cannot_be_written_are_told(tmp_path):
    (tmp_path / "run.log.markers.yaml").mkdir()
    with pytest.raises(WriteError, match=r"markers\.yaml: TRC101"):
        write(tmp_path / "run.log")


def test_after_an_exception_there_are_neither(tmp_path):
    with pytest.raises(KeyError), open_sink(tmp_path / "run.log", ENTITIES):
        raise KeyError
    assert list(tmp_path.iterdir()) == []


@given(
    name=st.one_of(
        st.text(min_size=1, max_size=8), st.sampled_from(["yes", "On", "null", "1.5", "0x10", "~", "- a", "a: b", "é"])
    )
)
def test_any_name_is_a_key(tmp_path_factory, name):
    path = tmp_path_factory.mktemp("logs") / "run.log"
    try:
        name.encode()
    except UnicodeEncodeError:
        return
    write(path, [Entity(EntityKind.TASK, name)], [])
    assert list(yaml.safe_load(path.with_name("run.log.markers.yaml").read_text())) == [name]


def test_what_is_written_is_read(tmp_path):
    trace = random_trace(Random(3), steps=300)
    path = tmp_path / "run.log"
    with open_sink(path, trace.entities) as sink:
        sink.write(trace)
    expected = [
        (time // US * US, 0x18000001 + 2 * target + (kind == EventKind.TERMINATE), instance)
        for time, kind, target, instance in zip(
            *(column.tolist() for column in (trace.time, trace.kind, trace.target, trace.target_instance)), strict=True
        )
        if kind in (EventKind.START, EventKind.TERMINATE)
    ]
    log = open_can_log(path)
    found = [(time, identifier & ~EXTENDED, int.from_bytes(data, "little")) for time, _, identifier, _, data in rows(log)]
    assert found == expected
    assert [finding.rule for finding in log.findings if finding.rule != "CAN010"] == []


def test_a_simulation_gives_a_log_with_its_execution_times(tmp_path):
    path = tmp_path / "run.log"
    simulate(ROOT / "samples" / "bodas-test-advanced.yaml", "40 ms", trace_paths=[path])
    markers = yaml.safe_load(path.with_name("run.log.markers.yaml").read_text())["Executor_Task"]
    starts, durations = {}, []
    for time, _, identifier, kind, data in rows(open_can_log(path)):
        assert kind is DATA
        if identifier == markers["start"] | EXTENDED:
            starts[data] = time
        elif identifier == markers["end"] | EXTENDED:
            durations.append(time - starts.pop(data))
    # Thesis, fig. 6.6: 12 us, and 25 us with a message, which comes every 20 ms.
    assert sorted(set(durations)) == [12 * US, 25 * US]
    assert durations.count(25 * US) == 2
    assert len(durations) == 40
