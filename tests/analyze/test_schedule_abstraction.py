"""The graph of all schedules of non-preemptive jobs: published examples, and every combination of releases and execution times."""

from itertools import product
from operator import le

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.analyze.response_times.schedule_abstraction import JobStream, explored

#: Long enough for all of the published jobs.
ONCE = 10_000


def job(release, cost, latest=None):
    return JobStream(period=ONCE, first=release, jitter=(latest or release) - release, demands=(cost,))


#: The state evolutions that the authors of the method check their own implementation with (np-schedulability-analysis,
#: src/tests/global.cpp, on one core): jobs by priority, and the earliest and latest end of each.
PUBLISHED = {
    "Find all next jobs": ([job(0, (3, 8)), job(7, (5, 5)), job(10, (1, 11))], [(3, 8), (12, 13), (13, 24)]),
    "Consider large enough interval": ([job(10, (5, 5)), job(7, (5, 5)), job(0, (3, 10))], [(15, 19), (12, 20), (3, 10)]),
    "Respect priorities": ([job(0, (5, 5)), job(0, (3, 10))], [(5, 5), (8, 15)]),
    "Respect jitter": ([job(0, (5, 5), 1), job(0, (3, 10), 1)], [(5, 15), (3, 16)]),
    "Be eager": ([job(10, (5, 5)), job(0, (1, 5)), job(0, (1, 20))], [(15, 30), (1, 5), (2, 25)]),
    "Be eager, with short deadline": ([job(30, (5, 5)), job(0, (1, 5)), job(9, (1, 15))], [(35, 35), (1, 5), (10, 24)]),
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_ends_are_those_that_the_authors_state(name):
    jobs, ends = PUBLISHED[name]
    for found, jobs_of_one, (earliest, latest) in zip(explored(jobs), jobs, ends, strict=True):
        assert found.latest == latest - jobs_of_one.first
        # The least time after the actual release is at least what is executed.
        assert found.earliest == max(jobs_of_one.demands[0][0], earliest - jobs_of_one.first - jobs_of_one.jitter)


def test_the_task_set_of_figure_1_meets_its_deadlines_with_the_long_task_before_the_middle_one():
    # [1, 2] every 10, [7, 8] and then 7 every 30, [3, 13] every 60. With the middle one first, the long one is started at 10 at the
    # latest beside the second job of the short one, which ends at 24 then, or after it, and ends at 25 (figure 2).
    short = JobStream(period=10, demands=((1, 2),))
    middle = JobStream(period=30, demands=((7, 8), (7, 7)))
    long = JobStream(period=60, demands=((3, 13),))
    assert [ends.latest for ends in explored([short, middle, long])] == [24 - 10, 10, 25]
    found = explored([short, long, middle])
    assert all(ends.latest <= period for ends, period in zip(found, (10, 60, 30), strict=True))
    # On two cores, the authors state that it does with the priorities of the figure, too.
    found = explored([short, middle, long], cores=2)
    assert all(ends.latest <= period for ends, period in zip(found, (10, 30, 60), strict=True))


def test_figure_1_of_2018_misses_a_deadline_on_two_cores():
    # The authors' job set (global_fig1_file), by priority, with its deadlines.
    jobs = [job(0, (2, 4)), job(0, (10, 15)), job(5, (1, 7)), job(8, (2, 3)), job(8, (1, 1))]
    late = [
        ends.latest + each.first > limit for ends, each, limit in zip(explored(jobs, 2), jobs, (7, 20, 15, 20, 14), strict=True)
    ]
    assert late == [False, False, False, False, True]


def test_a_core_is_free_with_the_first_of_two_jobs():
    # The state after two jobs of [5, 15] and [12, 30] (figure 3 of 2018): the first core is free in [5, 15].
    third = explored([job(0, (5, 15)), job(0, (12, 30)), job(0, (1, 1))], cores=2)[2]
    assert (third.earliest, third.latest) == (5 + 1, 15 + 1)


@st.composite
def streams(draw, shortest=(1, 4), periods=(15, 30)):
    least = draw(st.integers(*shortest))
    return JobStream(
        period=draw(st.sampled_from(periods)),
        first=draw(st.integers(0, 6)),
        jitter=draw(st.integers(0, 2)),
        demands=((least, least + draw(st.integers(0, 2))),),
    )


#: Jobs that are long for their distance in time, so that they meet on several cores.
LONG_STREAMS = streams((3, 9), (30,))


def played(streams, cores=1):
    """The latest end of a job of each task after its earliest release: each combination of releases and execution times of 30 units."""
    jobs = [(task, stream.first + start) for task, stream in enumerate(streams) for start in range(0, 30, stream.period)]
    late = [range(streams[task].jitter + 1) for task, _ in jobs]
    costs = [range(streams[task].demands[0][0], streams[task].demands[0][1] + 1) for task, _ in jobs]
    latest = [0] * len(streams)
    for delays, executed in product(product(*late), product(*costs)):
        left = {index: earliest + delays[index] for index, (_, earliest) in enumerate(jobs)}
        free = [0] * cores
        while left:
            now = max(min(free), min(left.values()))
            # Jobs are sorted by priority, then by release.
            index = min(index for index, release in left.items() if release <= now)
            del left[index]
            end = now + executed[index]
            free[free.index(min(free))] = end
            task, earliest = jobs[index]
            latest[task] = max(latest[task], end - earliest)
    return latest


@examples(16)
@given(st.lists(streams(), min_size=2, max_size=3))
def test_the_latest_end_is_that_of_the_worst_combination(streams):
    assert [ends.latest for ends in explored(streams)] == played(streams)


@examples(16)
@given(st.lists(LONG_STREAMS, min_size=3, max_size=5), st.integers(2, 3))
def test_no_combination_is_later_than_the_latest_end_on_several_cores(streams, cores):
    found = [ends.latest for ends in explored(streams, cores)]
    assert all(map(le, played(streams, cores), found))


def test_an_exploration_that_takes_too_many_steps_has_no_result():
    # Three jobs, each started in one state, in which three are looked at; then everything is as before.
    jobs = [JobStream(period=10, demands=((1, 2),))] * 3
    assert explored(jobs, max_steps=9) is not None
    assert explored(jobs, max_steps=8) is None
