"""State timelines: a line for each state that occurs, with its share of the window."""

import pytest
from svg_reading import assert_readable, rectangles, scale, texts

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.gantt import StateTimeline, state_timeline
from amalthea_uros.report.pictures.jobs import Job, ProcessRow, State, StateSpan
from amalthea_uros.units import MICROSECOND

US = MICROSECOND


def span(state, start, end):
    return StateSpan(state, start * US, end * US)


#: Runs for 20 us and 25 us, is preempted for 10 us, and waits for 5 us, in a window of 100 us.
JOB = Job(
    0,
    (
        span(State.RUNNING, 10, 30),
        span(State.READY, 30, 40),
        span(State.RUNNING, 40, 65),
        span(State.WAITING, 65, 70),
    ),
    10 * US,
    None,
    60 * US,
)


def drawn(*jobs, lost=()):
    return state_timeline(StateTimeline("a timeline", 0, 100 * US, ProcessRow("Task <1>", jobs, lost)))


def contents(picture):
    return [text.content for text in texts(picture)]


def test_each_state_has_its_share_of_the_window():
    found = contents(drawn(JOB))
    for state, share in [("running", "45.00 %"), ("ready", "10.00 %"), ("waiting", "5.00 %")]:
        assert found[found.index(state) + 1] == share
    assert not {"polling", "parking", "active"} & set(found)


def test_states_are_where_their_times_are():
    picture = drawn(JOB)
    x = scale(picture)
    [(left, width)] = rectangles(picture, ": ready for")
    assert (left, left + width) == pytest.approx((x(30), x(40)), abs=0.02)
    assert len(rectangles(picture, ": running for")) == 2


def test_states_have_lines_of_their_own():
    bases = {text.content: text.base for text in texts(drawn(JOB)) if text.content in ("running", "ready", "waiting")}
    assert len(set(bases.values())) == 3


def test_deadlines_and_lost_activations_are_shown():
    assert {"missed deadline", "lost activation"} <= set(contents(drawn(JOB, lost=(50 * US,))))


def test_text_is_readable():
    assert_readable(drawn(JOB, lost=(50 * US,)))


def test_a_process_without_jobs_says_so():
    assert "no job in this window" in contents(drawn())
    assert_readable(drawn())


def test_a_window_without_length_is_refused():
    with pytest.raises(InvalidArgumentError, match="must end after it starts"):
        StateTimeline("nothing", US, US, ProcessRow("Task", ()))


def test_hundreds_of_thousands_of_jobs_make_a_small_picture():
    jobs = tuple(Job(k, (StateSpan(State.RUNNING, k * 300, k * 300 + 100),), k * 300) for k in range(200_000))
    assert len(drawn(*jobs)) < 200_000
