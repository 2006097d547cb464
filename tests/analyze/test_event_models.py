"""Event models: eta+ and delta- are consistent, and no sequence of events exceeds them."""

import json
from fractions import Fraction
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import SHARED

from amalthea_uros.analyze.response_times import non_preemptive, priority_levels
from amalthea_uros.analyze.response_times.propagation import completions
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.distributions import Constant, Uniform
from amalthea_uros.perf.system import System
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.derived import AggregatedEventModel, Delayed, Downsampled, Multiplied, OutputEventModel
from amalthea_uros.timing.event_models.models import (
    EventModel,
    EventPattern,
    MinimumDistances,
    PeriodicEvents,
    SingleEvent,
    SporadicEvents,
)
from amalthea_uros.timing.event_models.stimuli import event_model_of

PERIODIC = st.builds(PeriodicEvents, st.integers(1, 30), st.integers(0, 80), st.integers(0, 5)).filter(
    lambda p: p.min_interarrival <= p.period
)
PATTERN = st.lists(st.integers(0, 19), min_size=1, max_size=4).map(lambda times: EventPattern(20, tuple(sorted(times))))
SIMPLE = st.one_of(PERIODIC, PATTERN, st.just(SingleEvent()), st.just(MinimumDistances(((2, 3), (4, 20)))))
MODELS = st.one_of(
    SIMPLE,
    st.builds(Downsampled, SIMPLE, st.integers(1, 4)),
    st.builds(Delayed, SIMPLE, st.integers(0, 30)),
    st.builds(OutputEventModel, SIMPLE, st.just((3, 7)), st.integers(0, 3)),
    st.lists(SIMPLE, min_size=1, max_size=3).map(lambda models: AggregatedEventModel(tuple(models))),
)


@given(MODELS, st.integers(1, 200))
def test_eta_plus_and_delta_min_are_consistent(model, window):
    count = model.eta_plus(window)
    # They span less than the window, and one more would not.
    assert model.delta_min(count) < window <= model.delta_min(count + 1)


@given(
    st.builds(PeriodicEvents, st.integers(1, 9), st.integers(0, 60), st.integers(0, 12)),
    st.lists(st.integers(1, 40), min_size=1, max_size=9).map(sorted),
    st.integers(0, 3),
    st.integers(2, 20),
)
def test_distances_of_completions_by_their_definition(events, completions, bcet, count):
    latest = enumerate(completions, start=1)
    between = min(events.delta_min(job + count - 1) - end for job, end in latest)
    expected = max((count - 1) * bcet, between + bcet)
    assert OutputEventModel(events, tuple(completions), bcet).delta_min(count) == expected


@given(MODELS)
def test_delta_min_is_monotonic(model):
    spans = [model.delta_min(count) for count in range(12)]
    assert spans == sorted(spans)
    assert spans[:2] == [0, 0]


@given(st.integers(1, 10), st.integers(0, 25), st.lists(st.integers(0, 25), min_size=12, max_size=12))
def test_no_jittering_events_are_denser_than_their_model(period, jitter, delays):
    times = sorted(index * period + min(delay, jitter) for index, delay in enumerate(delays))
    model = PeriodicEvents(period, jitter)
    for first in range(12):
        for last in range(first, 12):
            assert times[last] - times[first] >= model.delta_min(last - first + 1)


@given(PATTERN)
def test_a_pattern_is_as_dense_as_its_densest_place(pattern):
    times = [time + 20 * k for k in range(6) for time in pattern.times]
    for count in range(2, 2 * len(pattern.times) + 2):
        densest = min(times[i + count - 1] - times[i] for i in range(len(pattern.times)))
        assert pattern.delta_min(count) == densest


def test_several_events_for_each_one():
    repeated = Multiplied(PeriodicEvents(10), 3)
    assert [repeated.delta_min(count) for count in range(1, 8)] == [0, 0, 0, 10, 10, 10, 20]
    assert (repeated.eta_plus(11), repeated.rate) == (6, Fraction(3, 10))


@pytest.mark.parametrize(
    ("stimulus", "model"),
    [
        (perf.Periodic(name="s", period=10, offset=3), PeriodicEvents(10)),
        (perf.Periodic(name="s", period=10, jitter=Uniform(lower=-1, upper=3), min_distance=2), PeriodicEvents(10, 4, 2)),
        (perf.RelativePeriodic(name="s", distance=Uniform(lower=5, upper=9)), SporadicEvents(5, longest=9)),
        # Offset 5, period 10, length 5, distance 2, count 3: 5, 7, 9, 15, 17, 19 ...
        (perf.Burst(name="s", offset=5, period=10, length=5, distance=2, count=3), EventPattern(10, (0, 2, 4))),
        # The fourth occurrence would be after the burst; the third one, at exactly its end, counts.
        (perf.Burst(name="s", period=10, length=4, distance=2, count=4), EventPattern(10, (0, 2, 4))),
        (perf.Burst(name="s", period=10, length=0, distance=2, count=4), EventPattern(10, (0,))),
        (perf.Synthetic(name="s", period=10, times=(7, 1)), EventPattern(10, (1, 7))),
        (perf.Single(name="s", time=4), SingleEvent()),
        (
            perf.ArrivalCurve(
                name="s", points=(perf.ArrivalCurvePoint(occurrences=2, lower=3), perf.ArrivalCurvePoint(occurrences=3))
            ),
            MinimumDistances(((2, 3),)),
        ),
        # At most 4 in each 10.
        (perf.VariableRate(name="s", step=10, rate=Uniform(lower=1.0, upper=4.0)), SporadicEvents(2)),
        # At 50 Hz at most, every second revolution: 40 ms.
        (
            perf.VariableRate(name="s", step=1, rate=Constant(1.0), scenario=perf.Scenario(clock="engine", recurrence=2.0)),
            SporadicEvents(40 * 10**9),
        ),
        (
            perf.VariableRate(name="s", step=1, rate=Constant(1.0), scenario=perf.Scenario(clock="steps")),
            SporadicEvents(250 * 10**9),
        ),
        # Numbers that no analysis could go through.
        (perf.ArrivalCurve(name="s", points=(perf.ArrivalCurvePoint(occurrences=2**40, lower=3),)), None),
        (perf.Burst(name="s", period=2**40, length=2**40, count=2**40), None),
        (perf.Burst(name="s", period=10, length=4, distance=2, count=2**40), EventPattern(10, (0, 2, 4))),
        (perf.RelativePeriodic(name="s", distance=Uniform(lower=0, upper=9)), None),
        # Values without a meaning leave the rate unknown.
        (perf.RelativePeriodic(name="s", distance=Uniform(lower=-5, upper=9)), None),
        (perf.RelativePeriodic(name="s", distance=Uniform(lower=9, upper=5)), None),
        (perf.Periodic(name="s", period=10, jitter=Uniform(lower=3, upper=1)), None),
        (perf.Periodic(name="s", period=10, min_distance=-2), PeriodicEvents(10)),
        (perf.InterProcess(name="s"), None),
        (perf.Custom(name="s"), None),
    ],
)
def test_stimuli(stimulus, model):
    clocks = (
        perf.ClockFunction(name="engine", curve=perf.Curve.SINE, period=10, lowest=Fraction(20), swing=Fraction(30)),
        perf.ClockSteps(name="steps", steps=tuple(perf.ClockStep(time=t, frequency=Fraction(t)) for t in (1, 4, 2))),
    )
    assert event_model_of(stimulus, System(stimuli=perf.Stimuli(clocks=clocks))) == model


def test_the_tutorial_of_compositional_analysis():
    """Two tasks trigger two messages on a bus, which trigger two tasks (pyCPA's tutorial)."""
    path = SHARED / "vectors" / "compositional.json"
    if not path.exists():
        pytest.skip("the vectors are not at hand")
    case = json.loads(path.read_text())
    events = {name: PeriodicEvents(source["P"], source["J"]) for name, source in case["sources"].items()}
    worst = {}
    for resource, analysis in (
        ("CPU1", priority_levels.response_times),
        ("BUS", non_preemptive.response_times),
        ("CPU2", priority_levels.response_times),
    ):
        tasks = [
            # Lower numbers are more important there.
            AnalysedTask(
                name=t["name"],
                events=events[t["name"]],
                demand=MultiframeDemand.constant(t["wcet"], t["bcet"]),
                priority=-t["priority"],
            )
            for t in case["tasks"]
            if t["resource"] == resource
        ]
        for task, response in zip(tasks, analysis(tasks), strict=True):
            worst[task.name] = response.worst
            for chain in case["precedence"]:
                if task.name in chain[:-1]:
                    follower = chain[chain.index(task.name) + 1]
                    events[follower] = completions(task.events, response, task.demand.best)
    assert worst == case["expected_wcrt"]


@pytest.mark.parametrize(
    "derived", [partial(Delayed, variation=7), partial(Multiplied, factor=3), partial(Downsampled, prescaler=4)]
)
@pytest.mark.parametrize("source", [PeriodicEvents(10, 13, 2), SporadicEvents(9), EventPattern(20, (0, 3, 4)), SingleEvent()])
def test_most_events_in_a_window_are_those_that_the_distances_allow(source, derived):
    events = derived(source)
    for window in range(80):
        assert events.eta_plus(window) == EventModel.eta_plus(events, window)
