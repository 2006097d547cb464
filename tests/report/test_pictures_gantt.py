"""Gantt charts: boxes are where their times are, everything is readable, and size does not grow with the number of events."""

from itertools import pairwise

import pytest
from effort import IS_THOROUGH
from hypothesis import given
from hypothesis import strategies as st
from svg_reading import SVG, assert_readable, parsed, rectangles, scale, texts

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.chain_paths import ChainStep, DrawnPath
from amalthea_uros.report.pictures.gantt import GanttChart, gantt
from amalthea_uros.report.pictures.jobs import CoreRows, Job, ProcessRow, RunnableSpan, State, StateSpan
from amalthea_uros.units import MICROSECOND, MILLISECOND

US, MS = MICROSECOND, MILLISECOND
NASTY = """<Task & "friends'>"""


def span(state, start, end):
    return StateSpan(State(state), start * US, end * US, "Core_0")


def chart(*rows, start=0, end=100, chains=(), title="a chart"):
    return gantt(GanttChart(title, start * US, end * US, (CoreRows("Core_0", rows),), chains))


def contents(picture):
    return [text.content for text in texts(picture)]


#: High preempts Low from 20 us to 30 us; Low then waits from 40 us to 55 us.
HIGH = ProcessRow("High", (Job(7, (span("running", 20, 30),), 20 * US, 30 * US, 60 * US),))
LOW = ProcessRow(
    "Low",
    (
        Job(
            3,
            (
                span("running", 0, 20),
                span("ready", 20, 30),
                span("running", 30, 40),
                span("waiting", 40, 55),
                span("running", 55, 68),
            ),
            0,
            68 * US,
            90 * US,
        ),
    ),
)


def test_boxes_are_where_their_times_are():
    picture = chart(HIGH, LOW)
    x = scale(picture)
    for tip, start, end in [("High, job 7: running", 20, 30), ("Low, job 3: ready", 20, 30), ("Low, job 3: waiting", 40, 55)]:
        [(left, width)] = rectangles(picture, tip)
        assert left == pytest.approx(x(start), abs=0.02)
        assert left + width == pytest.approx(x(end), abs=0.02)
    assert len(rectangles(picture, "Low, job 3: running")) == 3


def test_a_box_tells_what_it_is():
    assert "High, job 7: running on Core_0 for 10 us from 20 us to 30 us" in chart(HIGH)


def test_boxes_end_with_the_window():
    picture = chart(LOW, start=10, end=35)
    x = scale(picture)
    (first, _), (last, width) = rectangles(picture, "job 3: running")
    assert first == pytest.approx(x(10), abs=0.02)
    assert last + width == pytest.approx(x(35), abs=0.02)


def test_boxes_that_only_touch_the_window_are_not_drawn():
    assert rectangles(chart(LOW, start=20, end=30), "running") == []


def test_states_differ_in_more_than_their_colour():
    states = [State.RUNNING, State.READY, State.WAITING, State.POLLING, State.PARKING, State.ACTIVE]
    row = ProcessRow("all", (Job(0, tuple(span(state, 10 * i, 10 * i + 10) for i, state in enumerate(states))),))
    groups = [node for node in parsed(chart(row)).iter(f"{SVG}g") if node.find(f"{SVG}rect/{SVG}title") is not None]
    looks = {(group.get("fill"), "empty" in group.get("class")) for group in groups}
    assert len(groups) == len(looks) == len(states)


def test_the_legend_has_only_what_is_shown():
    assert {"running", "activation", "deadline"} <= set(contents(chart(HIGH)))
    assert not {"ready (preempted)", "missed deadline", "lost activation", "runnable"} & set(contents(chart(HIGH)))
    assert "ready (preempted)" in contents(chart(LOW))


@pytest.mark.parametrize(
    ("end", "deadline", "is_missed"), [(30, 30, False), (31, 30, True), (None, 30, True), (None, 100, False), (30, None, False)]
)
def test_a_deadline_is_missed_by_a_job_that_ends_after_it_or_has_not_ended(end, deadline, is_missed):
    job = Job(0, (span("running", 20, 30),), 20 * US, end and end * US, deadline and deadline * US)
    picture = chart(ProcessRow("Task", (job,)))
    assert ("missed deadline" in contents(picture)) == is_missed
    assert ("0 s to 100 us, 1 process, 1 job, 1 missed deadline" in contents(picture)) == is_missed


def test_only_jobs_in_the_window_are_counted():
    assert "0 s to 100 us, 2 processes, 2 jobs" in contents(chart(HIGH, LOW))
    assert "0 s to 10 us, 2 processes, 1 job" in contents(chart(HIGH, LOW, end=10))
    assert "70 us to 80 us, 2 processes, 0 jobs" in contents(chart(HIGH, LOW, start=70, end=80))


def test_a_late_job_has_a_bar_from_its_deadline_to_its_end():
    picture = chart(ProcessRow("Task", (Job(0, (span("running", 0, 50),), 0, 50 * US, 40 * US),)))
    [path] = [
        node.get("d") for node in parsed(picture).iter(f"{SVG}path") if node.get("class") == "late" and "H" in node.get("d")
    ]
    x = scale(picture)
    assert float(path[1:].split()[0]) == pytest.approx(x(40), abs=0.02)
    assert float(path.split("H")[1].split("v")[0]) == pytest.approx(x(50), abs=0.02)


def test_activations_at_the_same_time_are_counted():
    row = ProcessRow("Task", tuple(Job(number, (), 50 * US) for number in range(3)))
    assert "\N{MULTIPLICATION SIGN}3" in contents(chart(row))


def test_lost_activations_are_shown():
    assert "lost activation" in contents(chart(ProcessRow("Task", (), (50 * US,))))


def test_a_job_without_length_is_drawn():
    picture = chart(ProcessRow("Task", (Job(0, (span("running", 50, 50),), 50 * US, 50 * US),)))
    [(left, width)] = rectangles(picture, "job 0")
    assert left == pytest.approx(scale(picture)(50), abs=0.02)
    assert width > 0


def test_a_chain_goes_from_step_to_step_and_has_its_latency_above():
    way = DrawnPath("sensor", (ChainStep("High", 30 * US), ChainStep("Low", 68 * US)), start=20 * US)
    picture = chart(HIGH, LOW, chains=(way,))
    x = scale(picture)
    assert "sensor: 48 us" in contents(picture)
    circles = [float(node.get("cx")) for node in parsed(picture).iter(f"{SVG}circle") if node.get("r") == "4"]
    assert circles == pytest.approx([x(30), x(68)], abs=0.02)


def test_steps_outside_of_the_window_or_of_unknown_processes_are_not_drawn():
    way = DrawnPath("sensor", (ChainStep("High", 30 * US), ChainStep("Nobody", 40 * US), ChainStep("Low", 168 * US)))
    picture = chart(HIGH, LOW, chains=(way,))
    assert "sensor: 138 us" in contents(picture)
    assert len([node for node in parsed(picture).iter(f"{SVG}circle") if node.get("r") == "4"]) == 1
    assert_readable(picture)


def test_runnables_are_boxes_with_names_in_those_of_their_process():
    job = Job(
        0, (span("running", 0, 60),), runnables=(RunnableSpan("read", 0, 30 * US), RunnableSpan("write", 30 * US, 31 * US))
    )
    picture = chart(ProcessRow("Task", (job,)))
    assert "read" in contents(picture)
    assert "write" not in contents(picture)
    assert "write: 1 us from 30 us on" in picture


def test_runnables_that_are_too_narrow_are_mentioned():
    job = Job(0, (span("running", 0, 60),), runnables=(RunnableSpan("read", 0, 1000),))
    assert any(text.startswith("Runnables of less than ") for text in contents(chart(ProcessRow("Task", (job,)))))


def test_names_are_escaped():
    way = DrawnPath(NASTY, (ChainStep(NASTY, 0), ChainStep(NASTY, 50 * US)))
    job = Job(0, (span("running", 0, 50),), runnables=(RunnableSpan(NASTY, 0, 50 * US),))
    picture = chart(ProcessRow(NASTY, (job,)), chains=(way,), title=NASTY)
    assert parsed(picture).findtext(f"{SVG}title") == NASTY
    assert contents(picture).count(NASTY) == 3
    assert f"{NASTY}: 50 us" in contents(picture)


def test_long_names_are_shortened_and_complete_in_the_tooltip():
    name = "Interrupt_service_routine_of_the_CAN_controller"
    picture = chart(ProcessRow(name, ()), title=3 * name)
    assert name not in contents(picture)
    assert any("\N{HORIZONTAL ELLIPSIS}" in text and text.startswith("Interrupt") for text in contents(picture))
    assert name in [node.text for node in parsed(picture).iter(f"{SVG}title")]
    assert_readable(picture)


def test_a_chart_without_processes_says_so():
    picture = gantt(GanttChart("nothing", 0, MS, ()))
    assert "no process in this window" in contents(picture)
    assert_readable(picture)


@pytest.mark.parametrize("end", [0, -1])
def test_a_window_without_length_is_refused(end):
    with pytest.raises(InvalidArgumentError, match="must end after it starts"):
        GanttChart("nothing", 0, end, ())


def test_a_picture_describes_itself_and_follows_the_colour_scheme():
    root = parsed(chart(HIGH))
    assert root.get("role") == "img"
    assert root.findtext(f"{SVG}title") == "a chart"
    assert root.findtext(f"{SVG}desc") == "0 s to 100 us, 1 process, 1 job"
    assert "prefers-color-scheme:dark" in root.findtext(f"{SVG}style")


def periodic(number, period, length):
    jobs = (
        Job(k, (StateSpan(State.RUNNING, k * period, k * period + length),), k * period, k * period + length)
        for k in range(number)
    )
    return ProcessRow("Task", tuple(jobs))


def test_boxes_that_cannot_be_told_from_each_other_are_one():
    # A thousand jobs of 1 us in a second: all boxes are narrower than a quarter of a pixel, and nearer than a pixel.
    picture = gantt(GanttChart("dense", 0, 10**12, (CoreRows("Core_0", (periodic(1000, MS, US),)),)))
    [(left, width)] = rectangles(picture, "Task: running 1000 times")
    x = scale(picture)
    assert left == pytest.approx(x(0), abs=0.02)
    assert left + width == pytest.approx(x(999.001), abs=0.3)
    assert any(text.startswith("Boxes of less than 3") and "merged" in text for text in contents(picture))


def test_boxes_that_can_be_told_from_each_other_are_not_merged():
    # Jobs of 3 us every ms in 21 ms: narrow boxes, far from each other.
    picture = gantt(GanttChart("sparse", 0, 21 * MS, (CoreRows("Core_0", (periodic(21, MS, 3 * US),)),)))
    assert len(rectangles(picture, "Task, job")) == 21
    assert not any("merged" in text for text in contents(picture))


def test_a_narrow_box_is_not_merged_with_a_wide_one():
    row = ProcessRow("Task", (Job(0, (span("running", 0, 50),)), Job(1, (StateSpan(State.RUNNING, 50 * US, 50 * US + 1000),))))
    assert len(rectangles(chart(row), "Task, job")) == 2


def test_hundreds_of_thousands_of_jobs_make_a_small_picture():
    jobs = 20_000 if IS_THOROUGH else 7_000
    rows = tuple(periodic(jobs, MS, 300 * US + 10 * US * number) for number in range(30))
    picture = gantt(GanttChart("dense", 0, jobs * MS, (CoreRows("Core_0", rows),)))
    assert len(picture) < 2_000_000
    parsed(picture)


def test_many_boxes_of_which_each_can_be_seen_make_a_small_picture():
    rows = tuple(periodic(1500, MS, 510 * US) for _ in range(30))
    picture = gantt(GanttChart("dense", 0, 1500 * MS, (CoreRows("Core_0", rows),)))
    assert len(picture) < 2_000_000


TIMES = st.integers(-20, 120)


OPTIONAL = st.none() | TIMES.map(lambda time: time * US)
NAMES = st.text(st.characters(max_codepoint=0x2FF), min_size=1, max_size=60)


@st.composite
def rows(draw):
    """Jobs in any state and of any fate, one after the other."""
    found = []
    for moments in batched(sorted(draw(st.lists(TIMES, max_size=12))), 4):
        spans = tuple(span(draw(st.sampled_from(State)), start, end) for start, end in pairwise(moments))
        called = tuple(RunnableSpan(draw(NAMES), item.start, item.end) for item in spans if draw(st.booleans()))
        found.append(Job(draw(st.integers(0, 10**6)), spans, draw(OPTIONAL), draw(OPTIONAL), draw(OPTIONAL), called))
    lost = draw(st.lists(TIMES, max_size=2))
    return ProcessRow(draw(NAMES), tuple(found), tuple(time * US for time in lost))


def batched(values, size):
    return [values[first : first + size] for first in range(0, len(values), size)]


@given(st.lists(rows(), max_size=4), NAMES, st.data())
def test_every_chart_is_well_formed_and_its_text_is_readable(drawn_rows, title, data):
    names = [row.name for row in drawn_rows] or ["none"]
    steps = st.builds(ChainStep, st.sampled_from(names), TIMES.map(lambda time: time * US))
    ways = st.builds(DrawnPath, NAMES, st.lists(steps, min_size=1, max_size=4).map(tuple))
    picture = chart(*drawn_rows, title=title, chains=tuple(data.draw(st.lists(ways, max_size=3))))
    assert_readable(picture)
