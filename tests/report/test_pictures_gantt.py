"""Gantt charts and state timelines: boxes are where their times are, texts can be read, and many events make no large picture."""

from itertools import pairwise

import pytest
from effort import IS_THOROUGH
from hypothesis import given
from hypothesis import strategies as st
from svg_reading import SVG, assert_readable, contents, parsed, rectangles, scale, texts, tooltips

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.chain_paths import ChainStep, DrawnPath
from amalthea_uros.report.pictures.gantt import GanttChart, StateTimeline, gantt, state_timeline
from amalthea_uros.report.pictures.jobs import CoreRows, Job, ProcessRow, RunnableSpan, State, StateSpan
from amalthea_uros.units import MICROSECOND, MILLISECOND

US, MS = MICROSECOND, MILLISECOND


def span(state, start, end):
    return StateSpan(State(state), start * US, end * US, "Core_0")


def job(number, *spans, activation=None, end=None, deadline=None, runnables=()):
    """A job with its times in microseconds."""
    activation, end, deadline = (None if time is None else time * US for time in (activation, end, deadline))
    called = tuple(RunnableSpan(name, start * US, stop * US) for name, start, stop in runnables)
    return Job(number, tuple(span(*each) for each in spans), activation, end, deadline, called)


def chart(*rows, start=0, end=100, chains=(), title="a chart"):
    return gantt(GanttChart(title, start * US, end * US, (CoreRows("Core_0", rows),), chains))


#: High preempts Low from 20 us to 30 us; Low then waits from 40 us to 55 us.
HIGH = ProcessRow("High", (job(7, ("running", 20, 30), activation=20, end=30, deadline=60),))
LOW_SPANS = (("running", 0, 20), ("ready", 20, 30), ("running", 30, 40), ("waiting", 40, 55), ("running", 55, 68))
LOW = ProcessRow("Low", (job(3, *LOW_SPANS, activation=0, end=68, deadline=90),))


def test_boxes_are_where_their_times_are():
    picture = chart(HIGH, LOW)
    x = scale(picture)
    for tip, start, end in [("High, job 7: running", 20, 30), ("Low, job 3: ready", 20, 30), ("Low, job 3: waiting", 40, 55)]:
        [(left, width)] = rectangles(picture, tip)
        assert (left, left + width) == pytest.approx((x(start), x(end)), abs=0.02)
    assert len(rectangles(picture, "Low, job 3: running")) == 3
    assert "High, job 7: running on Core_0 for 10 us from 20 us to 30 us" in picture


def test_boxes_end_with_the_window():
    picture = chart(LOW, start=10, end=35)
    x = scale(picture)
    (first, _), (last, width) = rectangles(picture, "job 3: running")
    assert (first, last + width) == pytest.approx((x(10), x(35)), abs=0.02)
    # Others only touch the window.
    assert rectangles(chart(LOW, start=20, end=30), "running") == []


def test_states_differ_in_more_than_their_colour():
    row = ProcessRow("all", (job(0, *((state, 10 * i, 10 * i + 10) for i, state in enumerate(State))),))
    groups = [node for node in parsed(chart(row)).iter(f"{SVG}g") if node.find(f"{SVG}rect/{SVG}title") is not None]
    looks = {(group.get("fill"), "empty" in group.get("class")) for group in groups}
    assert len(groups) == len(looks) == len(State)


def test_the_legend_has_only_what_is_shown():
    assert {"running", "activation", "deadline"} <= set(contents(chart(HIGH)))
    assert not {"ready (preempted)", "missed deadline", "lost activation", "runnable"} & set(contents(chart(HIGH)))
    assert "ready (preempted)" in contents(chart(LOW))
    assert "lost activation" in contents(chart(ProcessRow("Task", (), (50 * US,))))


@pytest.mark.parametrize(
    ("end", "deadline", "is_missed"), [(30, 30, False), (31, 30, True), (None, 30, True), (None, 100, False), (30, None, False)]
)
def test_a_deadline_is_missed_by_a_job_that_ends_after_it_or_has_not_ended(end, deadline, is_missed):
    late = job(0, ("running", 20, 30), activation=20, end=end, deadline=deadline)
    shown = contents(chart(ProcessRow("Task", (late,))))
    assert ("missed deadline" in shown) == ("0 s to 100 us, 1 process, 1 job, 1 missed deadline" in shown) == is_missed


def test_only_jobs_in_the_window_are_counted():
    assert "0 s to 100 us, 2 processes, 2 jobs" in contents(chart(HIGH, LOW))
    assert "0 s to 10 us, 2 processes, 1 job" in contents(chart(HIGH, LOW, end=10))
    assert "70 us to 80 us, 2 processes, 0 jobs" in contents(chart(HIGH, LOW, start=70, end=80))


def test_a_late_job_has_a_bar_from_its_deadline_to_its_end():
    picture = chart(ProcessRow("Task", (job(0, ("running", 0, 50), activation=0, end=50, deadline=40),)))
    paths = [node.get("d") for node in parsed(picture).iter(f"{SVG}path") if node.get("class") == "late"]
    [path] = [path for path in paths if "H" in path]
    ends = float(path[1:].split()[0]), float(path.split("H")[1].split("v")[0])
    assert ends == pytest.approx(tuple(map(scale(picture), (40, 50))), abs=0.02)


def test_activations_at_the_same_time_are_counted():
    row = ProcessRow("Task", tuple(job(number, activation=50) for number in range(3)))
    assert "\N{MULTIPLICATION SIGN}3" in contents(chart(row))


def test_a_job_without_length_is_drawn():
    picture = chart(ProcessRow("Task", (job(0, ("running", 50, 50), activation=50, end=50),)))
    [(left, width)] = rectangles(picture, "job 0")
    assert left == pytest.approx(scale(picture)(50), abs=0.02)
    assert width > 0


def steps(picture):
    return [float(node.get("cx")) for node in parsed(picture).iter(f"{SVG}circle") if node.get("r") == "4"]


def test_a_chain_goes_from_step_to_step_and_has_its_latency_above():
    way = DrawnPath("sensor", (ChainStep("High", 30 * US), ChainStep("Low", 68 * US)), start=20 * US)
    picture = chart(HIGH, LOW, chains=(way,))
    assert "sensor: 48 us" in contents(picture)
    assert steps(picture) == pytest.approx(list(map(scale(picture), (30, 68))), abs=0.02)


def test_steps_outside_of_the_window_or_of_unknown_processes_are_not_drawn():
    way = DrawnPath("sensor", (ChainStep("High", 30 * US), ChainStep("Nobody", 40 * US), ChainStep("Low", 168 * US)))
    picture = chart(HIGH, LOW, chains=(way,))
    assert "sensor: 138 us" in contents(picture)
    assert len(steps(picture)) == 1


def test_runnables_are_boxes_with_names_in_those_of_their_process():
    called = (("read", 0, 30), ("write", 30, 31))
    picture = chart(ProcessRow("Task", (job(0, ("running", 0, 60), runnables=called),)))
    assert "read" in contents(picture)
    assert "write" not in contents(picture)
    assert "write: 1 us from 30 us on" in picture
    narrow = chart(ProcessRow("Task", (job(0, ("running", 0, 60), runnables=(("read", 0, 0.001),)),)))
    assert any(text.startswith("Runnables of less than ") for text in contents(narrow))


def test_long_names_are_shortened_and_complete_in_the_tooltip():
    name = "Interrupt_service_routine_of_the_CAN_controller"
    picture = chart(ProcessRow(name, ()), title=3 * name)
    assert name not in contents(picture)
    assert any("\N{HORIZONTAL ELLIPSIS}" in text and text.startswith("Interrupt") for text in contents(picture))
    assert name in tooltips(picture)


def test_a_chart_without_processes_says_so():
    assert "no process in this window" in contents(gantt(GanttChart("nothing", 0, MS, ())))


@pytest.mark.parametrize("end", [0, -1])
@pytest.mark.parametrize(("kind", "rows"), [(GanttChart, ()), (StateTimeline, ProcessRow("Task", ()))])
def test_a_window_without_length_is_refused(kind, rows, end):
    with pytest.raises(InvalidArgumentError, match="must end after it starts"):
        kind("nothing", 0, end, rows)


def test_a_picture_describes_itself_and_follows_the_colour_scheme():
    root = parsed(chart(HIGH))
    described = (root.get("role"), root.findtext(f"{SVG}title"), root.findtext(f"{SVG}desc"))
    assert described == ("img", "a chart", "0 s to 100 us, 1 process, 1 job")
    assert "prefers-color-scheme:dark" in root.findtext(f"{SVG}style")


def periodic(number, period, length):
    releases = (k * period for k in range(number))
    return ProcessRow(
        "Task", tuple(Job(k, (StateSpan(State.RUNNING, at, at + length),), at, at + length) for k, at in enumerate(releases))
    )


def dense(number, *rows):
    return gantt(GanttChart("dense", 0, number * MS, (CoreRows("Core_0", rows),)))


def test_boxes_that_cannot_be_told_from_each_other_are_one():
    # A thousand jobs of 1 us in a second: all boxes are narrower than a quarter of a pixel, and nearer than a pixel.
    picture = dense(1000, periodic(1000, MS, US))
    [(left, width)] = rectangles(picture, "Task: running 1000 times")
    assert left == pytest.approx(scale(picture)(0), abs=0.02)
    assert left + width == pytest.approx(scale(picture)(999.001), abs=0.3)
    assert any(text.startswith("Boxes of less than 3") and "merged" in text for text in contents(picture))


def test_boxes_that_can_be_told_from_each_other_are_not_merged():
    # Jobs of 3 us every ms in 21 ms: narrow boxes, far from each other.
    picture = dense(21, periodic(21, MS, 3 * US))
    assert len(rectangles(picture, "Task, job")) == 21
    assert not any("merged" in text for text in contents(picture))
    # A narrow box beside a wide one.
    row = ProcessRow("Task", (job(0, ("running", 0, 50)), job(1, ("running", 50, 50.001))))
    assert len(rectangles(chart(row), "Task, job")) == 2


@pytest.mark.parametrize(("jobs", "length"), [(20_000 if IS_THOROUGH else 1500, 300 * US), (1500, 510 * US)])
def test_many_jobs_make_a_small_picture(jobs, length):
    rows = 30 if IS_THOROUGH else 8
    assert len(dense(jobs, *[periodic(jobs, MS, length)] * rows)) < rows * 66_000


TIMES = st.integers(-20, 120)
OPTIONAL = st.none() | TIMES
NAMES = st.text(st.characters(max_codepoint=0x2FF), min_size=1, max_size=60)


@st.composite
def rows(draw):
    """Jobs in any state and of any fate, one after the other."""
    moments = sorted(draw(st.lists(TIMES, max_size=12)))
    found = []
    for first in range(0, len(moments), 4):
        spans = [(draw(st.sampled_from(State)), *ends) for ends in pairwise(moments[first : first + 4])]
        called = [(draw(NAMES), start, end) for _, start, end in spans if draw(st.booleans())]
        ends = {key: draw(OPTIONAL) for key in ("activation", "end", "deadline")}
        found.append(job(draw(st.integers(0, 10**6)), *spans, runnables=called, **ends))
    lost = draw(st.lists(TIMES, max_size=2))
    return ProcessRow(draw(NAMES), tuple(found), tuple(time * US for time in lost))


@given(st.lists(rows(), max_size=4), NAMES, st.data())
def test_every_chart_is_well_formed_and_its_text_is_readable(drawn_rows, title, data):
    names = [row.name for row in drawn_rows] or ["none"]
    passed = st.builds(ChainStep, st.sampled_from(names), TIMES.map(lambda time: time * US))
    ways = st.builds(DrawnPath, NAMES, st.lists(passed, min_size=1, max_size=4).map(tuple))
    picture = chart(*drawn_rows, title=title, chains=tuple(data.draw(st.lists(ways, max_size=3))))
    assert_readable(picture)


# State timelines


#: Runs for 20 us and 25 us, is preempted for 10 us, and waits for 5 us, in a window of 100 us.
FOUR_STATES = (("running", 10, 30), ("ready", 30, 40), ("running", 40, 65), ("waiting", 65, 70))
JOB = job(0, *FOUR_STATES, activation=10, deadline=60)


def timeline(*jobs, lost=()):
    return state_timeline(StateTimeline("a timeline", 0, 100 * US, ProcessRow("Task <1>", jobs, lost)))


def test_each_state_has_a_line_with_its_share_of_the_window():
    picture = timeline(JOB)
    found = contents(picture)
    shares = {state: found[found.index(state) + 1] for state in ("running", "ready", "waiting")}
    assert shares == {"running": "45.00 %", "ready": "10.00 %", "waiting": "5.00 %"}
    assert not {"polling", "parking", "active"} & set(found)
    # Those of the legend come later, and are in one line.
    assert len({text.base for text in texts(picture) if text.content in shares}) == 3 + 1
    [(left, width)] = rectangles(picture, ": ready")
    assert (left, left + width) == pytest.approx(tuple(map(scale(picture), (30, 40))), abs=0.02)
    assert len(rectangles(picture, ": running")) == 2


def test_a_timeline_shows_deadlines_and_lost_activations():
    picture = timeline(JOB, lost=(50 * US,))
    assert {"missed deadline", "lost activation"} <= set(contents(picture))
    assert_readable(picture)


def test_a_process_without_jobs_says_so():
    assert "no job in this window" in contents(timeline())
    assert_readable(timeline())


def test_many_jobs_make_a_small_timeline():
    jobs = periodic(200_000 if IS_THOROUGH else 20_000, 300, 100).jobs
    assert len(timeline(*jobs)) < 200_000
