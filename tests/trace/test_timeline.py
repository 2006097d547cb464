"""What a picture of a trace shows, independent of its format and as JSON of Chrome's trace viewer."""

import json
from decimal import Decimal
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st
from test_btf_writer import CORE, ENTITIES, PREEMPTION, RUN, SLICES, STI_A, TASK_A, TASK_B
from traces import chunks, encoded, random_trace, table

from amalthea_uros.trace.table import Entity, EntityKind, EventKind
from amalthea_uros.trace.viewers.timeline import Timeline, TrackChange

K = EventKind


def marks(rows, entities=ENTITIES):
    timeline = Timeline()
    return [*timeline.marks(table(entities, rows)), *timeline.finish()]


def slices(marks, track):
    """The slices of a track: begin, end, depth, what it shows."""
    found, open_slices = [], []
    for mark in marks:
        if mark.track == track and mark.change is TrackChange.BEGIN:
            open_slices.append((mark.time, mark.state or mark.entity))
        elif mark.track == track and mark.change is TrackChange.END:
            begin, what = open_slices.pop()
            found.append((begin, mark.time, len(open_slices), what))
    assert open_slices == []
    return sorted(found, key=lambda found: (found[0], found[2], found[1]))


def test_a_preemption():
    shown = marks(PREEMPTION)
    for track in (CORE, TASK_A, TASK_B):
        found = slices(shown, track)
        # Runnables are in the states of their task.
        assert all(depth == (what == RUN) for _, _, depth, what in found)
        named = [what if isinstance(what, str) else ENTITIES[what].name for *_, what in found]
        assert [(*each[:2], name) for each, name in zip(found, named, strict=True)] == SLICES[ENTITIES[track].name]


def test_polling_and_waiting():
    kinds = [K.POLL, K.PARK, K.POLL_PARKING, K.RUN, K.WAIT, K.RELEASE, K.RESUME, K.TERMINATE]
    start = [(0, K.ACTIVATE, STI_A, 0, TASK_A, 0), (0, K.START, CORE, 0, TASK_A, 0)]
    shown = marks([*start, *((time, kind, CORE, 0, TASK_A, 0) for time, kind in enumerate(kinds, 1))])
    states = ["running", "polling", "parking", "polling", "running", "waiting", "ready", "running"]
    assert [found[3] for found in slices(shown, TASK_A)] == ["active", *states]
    assert slices(shown, CORE) == [(0, 2, 0, TASK_A), (3, 5, 0, TASK_A), (7, 8, 0, TASK_A)]


def test_a_job_that_waits_behind_another_one_of_its_task_is_shown_after_it():
    rows = [
        (0, K.ACTIVATE, STI_A, 0, TASK_A, 0),
        (0, K.START, CORE, 0, TASK_A, 0),
        (5, K.ACTIVATE, STI_A, 1, TASK_A, 1),
        (7, K.TERMINATE, CORE, 0, TASK_A, 0),
        (7, K.START, CORE, 0, TASK_A, 1),
        (9, K.TERMINATE, CORE, 0, TASK_A, 1),
    ]
    states = [(0, 0, 0, "active"), (0, 7, 0, "running"), (7, 7, 0, "active"), (7, 9, 0, "running")]
    assert slices(marks(rows), TASK_A) == states


def test_what_is_open_at_the_end_ends_with_the_last_event():
    shown = marks(PREEMPTION[:7])
    assert slices(shown, CORE) == [(100, 200, 0, TASK_A)]
    assert slices(shown, TASK_A)[1:] == [(100, 200, 0, "running"), (100, 200, 1, RUN)]


def test_steps_of_one_occurrence_have_the_same_flow():
    entities = [*ENTITIES, Entity(EntityKind.CHAIN, "First"), Entity(EntityKind.CHAIN, "Second")]
    steps = [(TASK_A, 7, 0, 0), (TASK_A, 8, 0, 0), (TASK_B, 7, 0, 1), (TASK_A, 7, 1, 0)]
    shown = marks(
        [(time, K.CHAIN_STEP, task, 0, chain, number, step) for time, (task, chain, number, step) in enumerate(steps)], entities
    )
    first, other_chain, second, other_occurrence = shown
    assert first.flow == second.flow
    assert len({first.flow, other_chain.flow, other_occurrence.flow}) == 3
    assert [(mark.track, mark.entity, mark.step) for mark in (first, second)] == [(TASK_A, 7, 0), (TASK_B, 7, 1)]


@given(st.randoms(use_true_random=False), st.integers(1, 40))
def test_the_slices_of_each_track_are_nested_and_fill_the_time_of_each_job(random, size):
    trace = random_trace(random, steps=150)
    timeline = Timeline()
    shown = [mark for part in chunks(trace, size) for mark in timeline.marks(part)]
    shown += timeline.finish()
    assert [mark.time for mark in shown] == sorted(mark.time for mark in shown)
    for track, entity in enumerate(trace.entities):
        if entity.kind in (EntityKind.TASK, EntityKind.ISR):
            states = [found for found in slices(shown, track) if found[2] == 0]
            assert all(before[1] <= after[0] for before, after in pairwise(states))
            running = sum(end - begin for begin, end, _, what in states if what in ("running", "polling"))
            on_cores = sum(end - begin for core in (0, 1) for begin, end, _, what in slices(shown, core) if what == track)
            assert running == on_cores


@given(st.randoms(use_true_random=False))
def test_without_the_suspensions_of_runnables_the_picture_is_the_same(random):
    trace = random_trace(random, steps=150)
    without = trace.where((trace.kind != K.RUNNABLE_SUSPEND) & (trace.kind != K.RUNNABLE_RESUME))
    assert list(Timeline().marks(without)) == list(Timeline().marks(trace))


def test_what_is_open_ends_where_events_are_lost():
    shown = marks([(0, K.ACTIVATE, STI_A, 0, TASK_A, 0), (1, K.START, CORE, 0, TASK_A, 0), (5, K.GAP, STI_A, 0, STI_A, 0)])
    assert slices(shown, CORE) == [(1, 5, 0, TASK_A)]
    assert slices(shown, TASK_A) == [(0, 1, 0, "active"), (1, 5, 0, "running")]


def events(*tables):
    return json.loads(encoded(".json", *tables), parse_float=Decimal)["traceEvents"]


def json_slices(found):
    """Name of the track, begin and end in picoseconds, name; in the order of the file."""
    tracks = {(event["pid"], event["tid"]): event["args"]["name"] for event in found if event["name"] == "thread_name"}
    return [
        (tracks[event["pid"], event["tid"]], event["ts"] * 10**6, (event["ts"] + event["dur"]) * 10**6, event["name"])
        for event in found
        if event["ph"] == "X"
    ]


def test_a_preemption_in_exact_times():
    shown = json_slices(events(table(ENTITIES, PREEMPTION)))
    assert {name: [each for track, *each in shown if track == name] for name in SLICES} == {
        name: list(map(list, slices)) for name, slices in SLICES.items()
    }


def test_no_thread_is_the_idle_one_or_the_main_one_of_its_process():
    shown = events(table(ENTITIES, PREEMPTION))
    threads = {(event["pid"], event["tid"]) for event in shown if event["ph"] == "X"}
    assert len(threads) == 3
    assert not {tid for _, tid in threads} & {0, *(pid for pid, _ in threads)}


def test_arrows_along_a_chain():
    entities = [*ENTITIES, Entity(EntityKind.CHAIN, 'The "chain"')]
    steps = [(1, TASK_A, 5, 0), (2, TASK_B, 5, 1), (3, TASK_A, 6, 0)]
    rows = [(time, EventKind.CHAIN_STEP, task, 0, 7, number, step) for time, task, number, step in steps]
    first, second, other = (event for event in events(table(entities, rows)) if event["ph"] == "X")
    assert first["name"] == 'The "chain"'
    assert first["bind_id"] == second["bind_id"] != other["bind_id"]
    assert [event["flow_out"] for event in (first, second, other)] == [True] * 3
    assert [event.get("flow_in") for event in (first, second, other)] == [None, True, None]


@given(st.randoms(use_true_random=False), st.integers(1, 40))
def test_a_slice_comes_after_those_around_it(random, size):
    trace = random_trace(random, steps=150)
    shown = json_slices(events(*chunks(trace, size)))
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
