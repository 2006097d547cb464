"""JSON of Chrome's trace viewer."""

import io
import json
from decimal import Decimal

from hypothesis import given
from hypothesis import strategies as st
from test_btf_writer import ENTITIES, PREEMPTION, TASK_A, TASK_B
from traces import chunks, random_trace, table

from amalthea_uros.trace.sinks import open_sink
from amalthea_uros.trace.table import Entity, EntityKind, EventKind
from amalthea_uros.trace.viewers.timeline import Timeline, TrackChange


def events(entities, *tables):
    stream = io.BytesIO()
    with open_sink(stream, entities, suffix=".json") as sink:
        for part in tables:
            sink.write(part)
    return json.loads(stream.getvalue(), parse_float=Decimal)["traceEvents"]


def slices(found):
    """Name of the track, begin and end in picoseconds, name; in the order of the file."""
    tracks = {(event["pid"], event["tid"]): event["args"]["name"] for event in found if event["name"] == "thread_name"}
    return [
        (tracks[event["pid"], event["tid"]], event["ts"] * 10**6, (event["ts"] + event["dur"]) * 10**6, event["name"])
        for event in found
        if event["ph"] == "X"
    ]


def test_a_preemption_in_exact_times():
    shown = slices(events(ENTITIES, table(ENTITIES, PREEMPTION)))
    assert [entry for entry in shown if entry[0] == "Task_A"] == [
        ("Task_A", 0, 100, "active"),
        ("Task_A", 100, 200, "running"),
        ("Task_A", 100, 200, "Run_1"),
        ("Task_A", 200, 300, "ready"),
        ("Task_A", 300, 400, "running"),
        ("Task_A", 300, 400, "Run_1"),
    ]
    assert [entry[1:] for entry in shown if entry[0] == "Core_1"] == [
        (100, 200, "Task_A"),
        (200, 300, "Task_B"),
        (300, 400, "Task_A"),
    ]


def test_no_thread_is_the_idle_one_or_the_main_one_of_its_process():
    shown = events(ENTITIES, table(ENTITIES, PREEMPTION))
    threads = {(event["pid"], event["tid"]) for event in shown if event["ph"] == "X"}
    assert len(threads) == 3
    assert not {tid for _, tid in threads} & {0, *(pid for pid, _ in threads)}


def test_arrows_along_a_chain():
    entities = [*ENTITIES, Entity(EntityKind.CHAIN, 'The "chain"')]
    steps = [(1, TASK_A, 5, 0), (2, TASK_B, 5, 1), (3, TASK_A, 6, 0)]
    rows = [(time, EventKind.CHAIN_STEP, task, 0, 7, number, step) for time, task, number, step in steps]
    first, second, other = (event for event in events(entities, table(entities, rows)) if event["ph"] == "X")
    assert first["name"] == 'The "chain"'
    assert first["bind_id"] == second["bind_id"] != other["bind_id"]
    assert [event["flow_out"] for event in (first, second, other)] == [True] * 3
    assert [event.get("flow_in") for event in (first, second, other)] == [None, True, None]


@given(st.randoms(use_true_random=False), st.integers(1, 40))
def test_a_slice_comes_after_those_around_it(random, size):
    trace = random_trace(random, steps=150)
    shown = slices(events(trace.entities, *chunks(trace, size)))
    timeline = Timeline()
    marks = [*timeline.marks(trace), *timeline.finish()]
    assert len(shown) == sum(mark.change is TrackChange.BEGIN for mark in marks)
    open_slices = {}
    for track, begin, end, _ in shown:
        stack = open_slices.setdefault(track, [])
        while stack and stack[-1] <= begin and not (stack[-1] == begin == end):
            stack.pop()
        assert not stack or end <= stack[-1]
        stack.append(end)
