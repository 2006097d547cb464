"""The latencies observed at a chain: against independent tools on simulated schedules, and against the definitions read literally."""

import heapq
import json
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from math import ceil

import numpy as np
import pytest
from effort import every
from hand_made_systems import READ, WRITE, Proc, access, system, ticks
from hypothesis import given
from hypothesis import strategies as st
from support import SHARED

from amalthea_uros import analyze_system
from amalthea_uros.analyze.chains.job_chains import build_job_chains
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.perf.constraints import Constraints, LatencyConstraint
from amalthea_uros.perf.events import EventChain, Parallel, ProcessChange, ProcessEvent, Segment, Sequence
from amalthea_uros.perf.software import Label
from amalthea_uros.simulate.kernel.layout import RESPONSE, STIMULUS
from amalthea_uros.simulate.metrics.chains import RouteMetrics, add_rows, chain_observation
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity as Q
from amalthea_uros.timing.observed import chain_latencies
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration

MAX_JOBS = 1500


@cache
def vectors():
    path = SHARED / "vectors" / "chains.json"
    return json.loads(path.read_text())["cases"] if path.exists() else []


def constant_cases():
    """Fixed priorities, one core, constant execution times, and not too many jobs."""
    found = [
        pytest.param(case, id=case["id"])
        for case in every(3, vectors())
        if case["kind"] in ("sync", "phase")
        and sum(case["hyperperiod"] // task["period"] for task in case["tasks"]) <= MAX_JOBS
    ]
    return found or [pytest.param(None, marks=pytest.mark.skip("the vectors are not at hand"))]


@dataclass
class Job:
    task: int
    release: int
    left: int
    start: int | None = None
    end: int | None = None


def play(tasks, until):
    """All jobs released before a time, as fixed-priority preemptive scheduling executes them; task 0 is the most important."""
    releases = [(time, number) for number, task in enumerate(tasks) for time in range(task["offset"], until, task["period"])]
    releases.sort()
    ready, jobs, now, upcoming = [], [], 0, 0
    while upcoming < len(releases) or ready:
        if not ready:
            now = max(now, releases[upcoming][0])
        while upcoming < len(releases) and releases[upcoming][0] <= now:
            time, number = releases[upcoming]
            jobs.append(Job(number, time, tasks[number]["wcet"]))
            heapq.heappush(ready, (tasks[number]["priority"], time, len(jobs) - 1))
            upcoming += 1
        job = jobs[ready[0][2]]
        job.start = now if job.start is None else job.start
        stop = releases[upcoming][0] if upcoming < len(releases) else now + job.left
        executed = min(job.left, stop - now)
        job.left, now = job.left - executed, now + executed
        if job.left == 0:
            job.end = now
            heapq.heappop(ready)
    return jobs


def observe(jobs, chain):
    """(time, kind, stamp) of a chain with implicit communication: a read at a time sees what was written up to that time."""
    position = {task: number for number, task in enumerate(chain)}
    accesses = []
    for index, job in enumerate(jobs):
        if job.task in position:
            accesses += [(job.start, 1, index), (job.end, 0, index)]
    registers, held, stimuli = [-1] * len(chain), {}, 0
    for time, is_read, index in sorted(accesses):
        step = position[jobs[index].task]
        if is_read and step == 0:
            held[index] = stimuli
            yield time, STIMULUS, stimuli
            stimuli += 1
        elif is_read:
            held[index] = registers[step - 1]
        else:
            registers[step] = held.pop(index)
            if step == len(chain) - 1:
                yield time, RESPONSE, registers[step]


def after(observations, begin):
    """What is observed from a time on, stimuli counted from there."""
    here = [each for each in observations if each[0] >= begin]
    first = next(stamp for _, kind, stamp in here if kind == STIMULUS)
    return [(time, kind, max(stamp - first, -1)) for time, kind, stamp in here]


def rows(observations, route=0):
    return np.array([(route, kind, time, stamp) for time, kind, stamp in observations], np.int64).reshape(-1, 4)


def quantities(*parts):
    metrics = RouteMetrics(1)
    for part in parts:
        metrics.add(rows(part))
    return metrics.observation("", 0).quantities


@pytest.mark.parametrize("case", constant_cases())
def test_a_played_schedule_has_the_latencies_that_independent_tools_compute(case):
    names = [task["name"] for task in case["tasks"]]
    chain = [names.index(name) for name in case["chain"]]
    cycle, longest = case["hyperperiod"], case["exact"]["mrt"]
    cycles = ceil((max(task["offset"] for task in case["tasks"]) + cycle + 2 * longest) / cycle)
    begin, end = cycles * cycle, cycles * cycle + cycle * (2 + ceil(2 * longest / cycle))
    observed = after(list(observe(play(case["tasks"], end + cycle), chain)), begin)
    one, more = (quantities([each for each in observed if each[0] < until]) for until in (end - cycle, end))

    maxima = {name: more[quantity].max for name, quantity in zip(("mrt", "mda", "mrda", "mrrt"), MAXIMA, strict=True)}
    assert maxima == case["exact"]
    if "distribution_one_hyperperiod" in case:
        for quantity in (Q.FIRST_TO_FIRST, Q.LAST_TO_LAST):
            expected = case["distribution_one_hyperperiod"][quantity]
            assert (more[quantity].min, more[quantity].max) == (expected["min"], expected["max"])
            assert more[quantity].count - one[quantity].count == expected["count"]
            assert more[quantity].total - one[quantity].total == expected["sum"]


MAXIMA = (Q.REACTION_TIME, Q.DATA_AGE, Q.REDUCED_DATA_AGE, Q.REDUCED_REACTION_TIME)


@pytest.mark.parametrize("case", constant_cases())
def test_a_played_schedule_has_the_exact_latencies_of_the_analysis(case):
    names = [task["name"] for task in case["tasks"]]
    chain = [names.index(name) for name in case["chain"]]
    cycle, longest = case["hyperperiod"], case["exact"]["mrt"]
    steady = cycle * ceil((max(task["offset"] for task in case["tasks"]) + cycle) / cycle)
    begin, end = (ceil((steady + number * longest) / cycle) * cycle for number in (2, 5))
    jobs = play(case["tasks"], end + 2 * cycle)
    analysed = build_job_chains([read_write_times(jobs, task, cycle, end + cycle) for task in chain], steady)
    found = quantities([each for each in after(list(observe(jobs, chain)), begin) if each[0] < end + cycle])

    expected = {
        Q.REACTION_TIME: analysed.reaction_time,
        Q.DATA_AGE: analysed.data_age,
        Q.FIRST_TO_FIRST: analysed.first_to_first.max(),
        Q.LAST_TO_LAST: analysed.last_to_last.max(),
        Q.LAST_TO_FIRST: analysed.inputs.last_to_first.max(),
        Q.FIRST_TO_LAST: analysed.inputs.first_to_last.max(),
    }
    assert {quantity: found[quantity].max for quantity in expected} == expected
    for quantity, times in ((Q.FIRST_TO_FIRST, analysed.first_to_first), (Q.LAST_TO_LAST, analysed.last_to_last)):
        assert found[quantity].min == times.min()
    assert found[Q.LAST_TO_FIRST].min == analysed.inputs.last_to_first.min()


def read_write_times(jobs, task, cycle, until):
    own = [job for job in jobs if job.task == task and job.release < until]
    releases, reads, writes = (np.array([getattr(job, name) for job in own]) for name in ("release", "start", "end"))
    return ReadWriteTimes(releases=releases, reads=reads, writes=writes, cycle=cycle, until=until)


# A sensor task with period 4 and an actuator task with period 6, as in docs/chains.md: both take 1 and nothing else executes. The
# sensor reads at 0, 4, 8, 12, ... and writes 1 later; the actuator reads at 0, 6, 12, 18 (0 sees nothing) and writes 1 later.
SENSOR = [(time, STIMULUS, number) for number, time in enumerate(range(0, 24, 4))]
ACTUATOR = [(1, RESPONSE, -1), (7, RESPONSE, 1), (13, RESPONSE, 2), (19, RESPONSE, 4)]
PICTURE = sorted(SENSOR + ACTUATOR)


@pytest.mark.parametrize(
    ("quantity", "values"),
    [
        (Q.REDUCED_REACTION_TIME, [7 - 0, 7 - 4, 13 - 8, 19 - 12, 19 - 16]),
        (Q.REACTION_TIME, [7 - 0, 13 - 4, 19 - 8, 19 - 12]),
        (Q.REDUCED_DATA_AGE, [7 - 4, 13 - 8, 19 - 16]),
        (Q.DATA_AGE, [13 - 4, 19 - 8]),
        (Q.LAST_TO_FIRST, [7 - 4, 13 - 8, 19 - 16]),
        (Q.FIRST_TO_LAST, [13 - 4]),
    ],
)
def test_the_latencies_of_two_tasks(quantity, values):
    found = quantities(PICTURE)[quantity]
    assert (found.count, found.min, found.max, found.total) == (len(values), min(values), max(values), sum(values))


def test_stimuli_without_a_response_are_counted():
    metrics = RouteMetrics(1)
    metrics.add(rows(PICTURE))
    observed = metrics.observation("", end=30)
    assert (observed.stimuli, observed.responses) == (6, 4)
    assert (observed.unanswered, observed.longest_unanswered) == (1, 30 - 20)


def test_the_extremes_are_found_again():
    found = quantities(PICTURE)[Q.REDUCED_REACTION_TIME]
    assert (found.at_max.instance, found.at_max.time) == (0, 0)
    assert (found.at_min.instance, found.at_min.time) == (1, 4)


def test_a_route_without_responses_has_no_latencies():
    metrics = RouteMetrics(3)
    metrics.add(rows(SENSOR))
    observed = metrics.observation("", end=30)
    assert observed.quantities == {}
    assert (observed.unanswered, observed.longest_unanswered) == (6, 10)


def test_the_chain_has_the_values_of_all_its_routes():
    slow = [(time + 5 * (kind == RESPONSE), kind, stamp) for time, kind, stamp in PICTURE]
    routes = {"fast": RouteMetrics(1), "slow": RouteMetrics(1)}
    mixed = np.concatenate([rows(PICTURE), rows(sorted(slow), route=1)])
    add_rows(mixed[np.argsort(mixed[:, 2], kind="stable")], list(routes.values()))
    found = chain_observation("c", list(routes.items()), end=30)
    assert [route.text for route in found.routes] == ["fast", "slow"]
    assert found.observations == 10
    latency = found.quantities[Q.FIRST_TO_FIRST]
    assert (latency.min, latency.max, latency.count) == (3, 12, 10)
    assert latency.total == sum([7, 3, 5, 7, 3]) + sum([12, 8, 10, 12, 8])


# The definitions, read literally


@st.composite
def observations(draw):
    """Stimuli and responses at any times; a response shows one of the stimuli before it, mostly the same or a newer one."""
    time, stimuli, found = 0, 0, []
    for _ in range(draw(st.integers(0, 30))):
        time += draw(st.integers(0, 5))
        if draw(st.booleans()):
            found.append((time, STIMULUS, stimuli))
            stimuli += 1
        else:
            found.append((time, RESPONSE, draw(st.integers(-1, stimuli - 1))))
    return found


def literal(observed):
    start = {stamp: time for time, kind, stamp in observed if kind == STIMULUS}
    outputs = [(time, stamp) for time, kind, stamp in observed if kind == RESPONSE]
    answers = {k: next((time for time, stamp in outputs if stamp >= k), None) for k in start}
    found = {quantity: [] for quantity in chain_latencies.MEASURED}
    for k, answer in answers.items():
        if answer is not None:
            found[Q.REDUCED_REACTION_TIME].append(answer - start[k])
            if k > 0:
                found[Q.REACTION_TIME].append(answer - start[k - 1])
    for number, (time, stamp) in enumerate(outputs):
        if stamp >= 0:
            found[Q.REDUCED_DATA_AGE].append(time - start[stamp])
            if number + 1 < len(outputs):
                found[Q.DATA_AGE].append(outputs[number + 1][0] - start[stamp])
    shown = []
    for time, stamp in outputs:
        if stamp >= 0 and stamp >= max((each for _, each in shown), default=-1):
            shown.append((time, stamp))
    inputs = sorted({stamp for _, stamp in shown})
    for number, stamp in enumerate(inputs):
        times = [time for time, each in shown if each == stamp]
        found[Q.LAST_TO_FIRST].append(times[0] - start[stamp])
        if 0 < number < len(inputs) - 1:
            found[Q.FIRST_TO_LAST].append(times[-1] - start[inputs[number - 1]])
    return found


def summary(values):
    return (len(values), min(values), max(values), sum(values)) if values else None


@given(observations(), st.lists(st.integers(0, 30)))
def test_the_latencies_are_as_defined_in_any_chunks(observed, cuts):
    edges = [0, *sorted(cuts), len(observed)]
    found = quantities(*(observed[first:end] for first, end in pairwise(edges)))
    for quantity, values in literal(observed).items():
        one = found.get(quantity)
        assert (one and (one.count, one.min, one.max, one.total)) == summary(values)
        if one is not None:
            assert sum(one.histogram.counts) == len(values)


@given(observations(), st.lists(st.integers(0, 30)), st.integers(1, 4))
def test_what_is_no_longer_kept_is_counted_in_any_chunks(observed, cuts, window):
    edges = [0, *sorted(cuts), len(observed)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(chain_latencies, "WINDOW", window)
        whole, chunked = RouteMetrics(1), RouteMetrics(1)
        whole.add(rows(observed))
        for first, end in pairwise(edges):
            chunked.add(rows(observed[first:end]))
    one, other = whole.observation("", 200), chunked.observation("", 200)
    assert {q: (v.count, v.min, v.max, v.total) for q, v in one.quantities.items()} == {
        q: (v.count, v.min, v.max, v.total) for q, v in other.quantities.items()
    }
    assert one.not_evaluated == other.not_evaluated
    evaluated = sum(found.count for q, found in one.quantities.items() if q in (Q.REDUCED_REACTION_TIME, Q.REDUCED_DATA_AGE))
    complete = literal(observed)
    assert evaluated + one.not_evaluated == len(complete[Q.REDUCED_REACTION_TIME]) + len(complete[Q.REDUCED_DATA_AGE])


# Reactions of chains with parallel parts: one of them is enough, or all are needed.


def verdicts(completed, **limits):
    """What a simulation and the analysis say about limits of two ways, of which a number has to be completed."""
    # A starts at 0, and R ends at 4 with what A wrote; B reads it at 10, so that R gets that way only at 20, in the next job.
    names = ("A", "B", "R")
    events = tuple(
        ProcessEvent(name=f"{name} {change}", process=name, change=change)
        for name in names
        for change in (ProcessChange.START, ProcessChange.TERMINATE)
    )
    ways = (("A start", "R terminate"), ("A start", "B terminate", "R terminate"))
    branches = tuple(
        Segment(
            stimulus=way[0],
            response=way[-1],
            items=Sequence(tuple(Segment(stimulus=one, response=other) for one, other in pairwise(way))),
        )
        for way in ways
    )
    chain = EventChain(
        name="ways", stimulus="A start", response="R terminate", items=Parallel(items=branches, completed=completed)
    )
    built = system(
        Proc("A", (ticks(1), access("L", WRITE), access("K", WRITE)), 20, priority=3),
        Proc("B", (access("K", READ), ticks(1), access("M", WRITE)), 20, 10, priority=2),
        Proc("R", (access("L", READ), access("M", READ), ticks(3)), 20, priority=1),
        labels=tuple(Label(name=name) for name in "KLM"),
        events=events,
        chains=(chain,),
    )
    limit = LatencyConstraint(name="limit", chain="ways", **limits)
    built = replace(built, constraints=Constraints(constraints=(limit,)))
    (found,) = simulate_system(built, Options(duration=Duration(200 * US))).requirements
    (proved,) = analyze_system(built).requirements
    return found.verdict, str(proved.verdict)


def test_a_limit_of_the_way_that_is_completed_last():
    assert verdicts(1, maximum=10 * US) == (ObservedVerdict.NOT_OBSERVED, "met")
    assert verdicts(2, maximum=10 * US) == (ObservedVerdict.MISSED, "unknown")


def test_a_limit_of_the_way_that_is_completed_first():
    assert verdicts(1, minimum=15 * US) == (ObservedVerdict.MISSED, "missed")
    # R is completed after 4 us by the one way, but by both of them after 24 us.
    assert verdicts(2, minimum=15 * US) == (ObservedVerdict.NOT_OBSERVED, "unknown")
