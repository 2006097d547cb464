"""Occurrences of stimuli: what they state, within the event models that the analyses take them for."""

from fractions import Fraction

import numpy as np
import pytest
from effort import examples
from hypothesis import assume, given
from hypothesis import strategies as st

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import Boundaries, Bucket, Constant, Gauss, Histogram, Sampling, Statistics, Uniform
from amalthea_uros.perf.stimuli import (
    ArrivalCurve,
    ArrivalCurvePoint,
    Burst,
    ClockFunction,
    ClockStep,
    ClockSteps,
    Curve,
    Custom,
    EventTriggered,
    InterProcess,
    Periodic,
    RelativePeriodic,
    Scenario,
    Single,
    Stimuli,
    Synthetic,
    VariableRate,
)
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.arrivals import occurrences
from amalthea_uros.simulate.options import Mode
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.units import SECOND

CLOCKS = (
    ClockSteps(
        name="steps", steps=(ClockStep(time=0, frequency=Fraction(1)), ClockStep(time=9, frequency=Fraction(4))), period=20
    ),
    ClockFunction(name="triangle", curve=Curve.TRIANGLE, period=400, lowest=Fraction(10**10), swing=Fraction(10**11)),
    ClockFunction(name="sine", curve=Curve.SINE, period=300, lowest=Fraction(0), swing=Fraction(10**11)),
)
SYSTEM = System(stimuli=Stimuli(clocks=CLOCKS))


def start(stimulus, mode=Mode.SAMPLED, seed=1, time_base=1):
    return occurrences(stimulus, SYSTEM, mode, RandomSource(seed, f"stimulus {stimulus.name}"), time_base)


def times(stimulus, limit, mode=Mode.SAMPLED, **more):
    return start(stimulus, mode, **more).until(limit).tolist()


def named(cls, *args, **more):
    return cls(*args, name="stimulus", **more)


def curve(*points):
    return named(
        ArrivalCurve, points=tuple(ArrivalCurvePoint(occurrences=n, lower=lower, upper=upper) for n, lower, upper in points)
    )


@pytest.mark.parametrize(
    ("stimulus", "limit", "expected"),
    [
        (named(Periodic, period=10, offset=3), 34, [3, 13, 23, 33]),
        (named(Periodic, period=10, min_distance=15), 60, [0, 15, 30, 45]),
        # The documented burst; others are clipped at their length.
        (named(Burst, offset=5, period=10, length=5, distance=2, count=3), 30, [5, 7, 9, 15, 17, 19, 25, 27, 29]),
        (named(Burst, period=100, length=10, distance=4, count=9), 101, [0, 4, 8, 100]),
        (named(Burst, period=100, length=10, count=2), 101, [0, 0, 100, 100]),
        # Synthetic times repeat and may exceed the period.
        (named(Synthetic, offset=5, period=10, times=(3, 1)), 30, [6, 8, 16, 18, 26, 28]),
        (named(Synthetic, period=10, times=(0, 12)), 31, [0, 10, 12, 20, 22, 30]),
        (named(Single, time=7), 100, [7]),
        (named(Single, time=7), 7, []),
        # Occurrences of a step are evenly distributed, and fractions are carried over.
        (named(VariableRate, step=100, rate=Constant(4.0)), 201, [25, 50, 75, 100, 125, 150, 175, 200]),
        (named(VariableRate, step=100, rate=Constant(0.4)), 1001, [250, 500, 750, 1000]),
    ],
)
def test_occurrences_without_chance(stimulus, limit, expected):
    assert times(stimulus, limit) == expected


def test_the_time_base_divides_a_picosecond():
    assert times(named(Periodic, period=10, offset=3), 34, time_base=3) == [9]


def test_jitter_is_around_the_ideal_grid():
    found = np.array(times(named(Periodic, period=100, offset=50, jitter=Uniform(lower=-30, upper=40)), 10**6))
    shifts = found - 50 - 100 * np.arange(len(found))
    assert (shifts.min(), shifts.max()) == (-30, 40)
    assert np.mean(shifts) == pytest.approx(5, abs=1.5)


def test_occurrences_keep_their_minimum_distance():
    # After a late one, an early one has to wait from 10 to 40 after its ideal time.
    jitter = Histogram((Bucket(lower=0, upper=0, occurrences=1), Bucket(lower=90, upper=90, occurrences=1)))
    found = np.array(times(named(Periodic, period=100, jitter=jitter, min_distance=50), 10**5))
    distances = np.diff(found)
    assert set(distances.tolist()) == {50, 60, 100, 150, 190}


def test_what_jitter_moves_to_before_0_occurs_at_0():
    early = named(Periodic, period=10, offset=2, jitter=Uniform(lower=-5, upper=0))
    firsts = {times(early, 5, seed=seed)[0] for seed in range(30)}
    assert firsts == {0, 1, 2}
    assert any("before the start" in sentence for sentence in start(early).assumptions)
    # Without a chance to occur after 0, an occurrence is left out.
    always_early = named(Periodic, period=10, jitter=Uniform(lower=-5, upper=-2))
    assert all(5 <= times(always_early, 20, seed=seed)[0] <= 8 for seed in range(30))
    assert start(always_early).assumptions == ()


@pytest.mark.parametrize("mode", [Mode.WORST, Mode.BEST, Mode.AVERAGE])
def test_without_sampling_jitter_and_distances_are_constant(mode):
    """The worst case of sporadic occurrences is the shortest distance."""
    shift, distance = {Mode.WORST: (9, 20), Mode.BEST: (1, 40), Mode.AVERAGE: (5, 30)}[mode]
    periodic = named(Periodic, period=100, jitter=Uniform(lower=1, upper=9))
    assert times(periodic, 300, mode) == [shift, shift + 100, shift + 200]
    sporadic = named(RelativePeriodic, distance=Uniform(lower=20, upper=40), offset=5)
    assert times(sporadic, 100, mode) == list(range(5, 100, distance))


def test_distances_are_sampled():
    found = np.diff(times(named(RelativePeriodic, distance=Uniform(lower=20, upper=40), has_maximum=False), 10**6))
    assert (found.min(), found.max()) == (20, 40)
    assert np.mean(found) == pytest.approx(30, abs=0.3)
    sporadic = start(named(RelativePeriodic, distance=Boundaries(lower=20, upper=40), has_maximum=False))
    assert len(sporadic.assumptions) == 2


@pytest.mark.parametrize(("mode", "expected"), [(Mode.WORST, 4000), (Mode.BEST, 1000), (Mode.AVERAGE, 2500)])
def test_the_worst_case_of_a_rate_is_the_highest(mode, expected):
    rate = named(VariableRate, step=100, rate=Uniform(lower=1.0, upper=4.0))
    assert len(times(rate, 100_001, mode)) == expected


def test_the_rate_changes_no_more_than_is_stated():
    rate = named(VariableRate, step=10**6, rate=Uniform(lower=10.0, upper=1000.0), max_increase=20.0, max_decrease=5.0)
    counts = np.bincount(np.array(times(rate, 10**9)) // 10**6)
    changes = np.diff(counts)
    # A count differs from the rate by less than 1.
    assert -7 <= changes.min() < -4
    assert 19 < changes.max() <= 22


def test_the_documented_scenario():
    driven = named(VariableRate, step=1, rate=Constant(1.0), scenario=Scenario(clock="c", offset=0.0833, recurrence=2.0))
    clock = ClockFunction(name="c", curve=Curve.TRIANGLE, period=2 * SECOND, lowest=Fraction(45), swing=Fraction(10))
    system = System(stimuli=Stimuli(clocks=(clock,)))
    found = occurrences(driven, system, Mode.SAMPLED, RandomSource(1, ""), 1).until(SECOND // 10)
    assert (found / SECOND).tolist() == pytest.approx([1.666e-3, 41.49e-3, 81.01e-3], abs=5e-6)


def test_a_scenario_has_no_occurrence_at_an_area_of_0():
    clock = ClockSteps(
        name="c", steps=(ClockStep(time=0, frequency=Fraction(1)), ClockStep(time=5 * SECOND, frequency=Fraction(0)))
    )
    system = System(stimuli=Stimuli(clocks=(clock,)))
    for offset, expected in ((0, [2, 4]), (-3, [1, 3, 5]), (1, [1, 3, 5])):
        driven = named(VariableRate, step=1, rate=Constant(1.0), scenario=Scenario(clock="c", offset=offset, recurrence=2))
        found = occurrences(driven, system, Mode.SAMPLED, RandomSource(1, ""), 1)
        assert (found.until(100 * SECOND) // SECOND).tolist() == expected
        assert found.until(200 * SECOND).tolist() == []


JITTER = st.one_of(
    st.none(),
    st.tuples(st.integers(-60, 60), st.integers(0, 60)).flatmap(
        lambda pair: st.sampled_from(
            [
                Uniform(lower=pair[0], upper=sum(pair)),
                Boundaries(lower=pair[0], upper=sum(pair), sampling=Sampling.CORNER_CASE),
                Statistics(lower=pair[0], average=pair[0] + pair[1] / 3, upper=sum(pair)),
                Gauss(mean=0.0, deviation=30.0, lower=pair[0], upper=sum(pair)),
            ]
        )
    ),
)
PERIODIC = st.builds(
    Periodic,
    name=st.just("stimulus"),
    period=st.integers(1, 40),
    offset=st.integers(-50, 50),
    jitter=JITTER,
    min_distance=st.one_of(st.none(), st.integers(0, 50)),
)
RELATIVE = st.builds(
    lambda low, more, offset, has_maximum: named(
        RelativePeriodic, distance=Uniform(lower=low, upper=low + more), offset=offset, has_maximum=has_maximum
    ),
    st.integers(1, 30),
    st.integers(0, 30),
    st.integers(0, 30),
    st.booleans(),
)
SYNTHETIC = st.builds(
    Synthetic,
    name=st.just("stimulus"),
    period=st.integers(1, 40),
    times=st.lists(st.integers(0, 99), min_size=1, max_size=4).map(tuple),
    offset=st.integers(-50, 50),
)
BURST = st.builds(
    Burst,
    name=st.just("stimulus"),
    period=st.integers(1, 60),
    length=st.integers(0, 40),
    distance=st.integers(0, 9),
    count=st.integers(1, 5),
    offset=st.integers(-50, 50),
)
RATE = st.builds(
    lambda step, low, more, changes: named(
        VariableRate,
        step=step,
        rate=Uniform(lower=low, upper=low + more),
        max_increase=changes[0],
        max_decrease=changes[1],
    ),
    st.integers(1, 100),
    st.floats(0, 3),
    st.floats(0.1, 3),
    st.tuples(st.one_of(st.none(), st.floats(0, 2)), st.one_of(st.none(), st.floats(0, 2))),
)
SCENARIO = st.builds(
    lambda clock, offset, recurrence: named(
        VariableRate, step=1, rate=Constant(1.0), scenario=Scenario(clock=clock, offset=offset, recurrence=recurrence)
    ),
    st.sampled_from(["triangle", "sine"]),
    st.floats(-2, 2),
    st.floats(0.3, 3),
)
POINT = st.tuples(st.integers(2, 5), st.one_of(st.none(), st.integers(0, 40)), st.one_of(st.none(), st.integers(10, 90)))
CURVE = st.lists(POINT, min_size=1, max_size=4).map(lambda points: curve(*points))
STIMULI = st.one_of(PERIODIC, RELATIVE, SYNTHETIC, BURST, RATE, SCENARIO, CURVE, st.just(named(Single, time=3)))


def started(stimulus, mode, seed=1, time_base=1):
    """The occurrences; stimuli that cannot be simulated are not wanted."""
    try:
        return start(stimulus, mode, seed, time_base)
    except UnknownError:
        assume(False)


@given(STIMULI, st.sampled_from(Mode), st.integers(1, 3), st.integers(0, 99))
def test_no_occurrences_violate_the_event_model(stimulus, mode, time_base, seed):
    model = event_model_of(stimulus, SYSTEM)
    assume(model is not None)
    found = started(stimulus, mode, seed, time_base).until(1500 * time_base)
    assert (np.diff(found) >= 0).all()
    assert not len(found) or found[0] >= 0
    for count in range(2, min(40, len(found) + 1)):
        assert (found[count - 1 :] - found[: 1 - count]).min() >= model.delta_min(count) * time_base
    longest = model.max_interarrival
    # At first, occurrences of earlier periods are missing.
    later = found[found >= 200 * time_base]
    if longest is not None and len(later) > 1:
        assert np.diff(later).max() <= max(longest, getattr(stimulus, "min_distance", None) or 0) * time_base


@given(STIMULI, st.sampled_from(Mode), st.lists(st.integers(0, 700), max_size=5))
def test_occurrences_do_not_depend_on_how_time_is_cut(stimulus, mode, limits):
    whole = started(stimulus, mode).until(700).tolist()
    parts = started(stimulus, mode)
    cut = [parts.until(limit).tolist() for limit in [*sorted(limits), 700]]
    assert [time for part in cut for time in part] == whole
    assert all(time < limit for part, limit in zip(cut, sorted(limits), strict=False) for time in part)


def earliest_by_relaxation(stimulus, count):
    """The earliest occurrences within the limits, by trial: each is moved to later until all limits hold; None if they never do."""
    found = [0] * count
    for _ in range(20 * count):
        before = list(found)
        for index in range(1, count):
            found[index] = max(found[index], found[index - 1])
        for point in stimulus.points:
            for last in range(point.occurrences - 1, count):
                first = last - point.occurrences + 1
                found[last] = max(found[last], found[first] + (point.lower or 0))
                if point.upper is not None:
                    found[first] = max(found[first], found[last] - point.upper)
        if found[0] > 0:
            return None
        if found == before:
            return found
    return None


@examples(6)  # the relaxation takes long
@given(CURVE)
def test_the_worst_case_of_an_arrival_curve_is_as_early_as_its_borders_allow(stimulus):
    expected = earliest_by_relaxation(stimulus, 40)
    if expected is None:
        with pytest.raises(UnknownError, match=r"contradict|no borders"):
            start(stimulus, Mode.WORST)
    elif expected[-1] == 0:
        with pytest.raises(UnknownError, match=r"unlimited number|no borders"):
            start(stimulus, Mode.WORST)
    else:
        # The last ones of the trial have no followers that they must not be too far from.
        assert start(stimulus, Mode.WORST).until(10**6)[:25].tolist() == expected[:25]


@given(CURVE, st.sampled_from(Mode), st.integers(0, 99))
def test_occurrences_are_within_both_borders_of_an_arrival_curve(stimulus, mode, seed):
    found = started(stimulus, mode, seed).until(3000)
    for point in stimulus.points:
        spans = found[point.occurrences - 1 :] - found[: len(found) - point.occurrences + 1]
        assert (spans >= (point.lower or 0)).all()
        assert point.upper is None or (spans <= point.upper).all()


def test_the_best_case_of_an_arrival_curve_is_as_late_as_its_borders_allow():
    assert times(curve((2, 5, 20), (3, None, 30)), 100, Mode.BEST) == [0, 20, 30, 50, 60, 80, 90]


def test_a_lower_border_excludes_distances_after_which_an_upper_one_cannot_be_met():
    # Three span 10 at most, and two 4 at least: so no distance is greater than 6.
    found = np.diff(times(curve((2, 4, None), (3, None, 10)), 10**4))
    assert set(found.tolist()) == {4, 5, 6}


def test_stimuli_that_are_triggered_have_no_occurrences_of_their_own():
    assert times(named(InterProcess), 100) == []
    assert times(named(EventTriggered, events=()), 100) == []


@pytest.mark.parametrize(
    ("stimulus", "text"),
    [
        (named(Periodic, period=0), "period"),
        (named(Periodic, period=-1, jitter=Uniform(lower=0, upper=1)), "period"),
        (named(Periodic, period=1, jitter=Uniform(lower=1, upper=0)), "minimum of a distribution"),
        (named(Periodic, period=2**62), "exceeds the supported range"),
        (named(RelativePeriodic, distance=Uniform(lower=-1, upper=5)), "negative"),
        (named(RelativePeriodic, distance=Constant(0)), "zero"),
        (named(RelativePeriodic, distance=Constant(1), offset=-1), "offset"),
        (named(Synthetic, period=10, times=()), "times"),
        (named(Synthetic, period=10, times=(-1,)), "negative"),
        (named(Burst, period=10, length=5, distance=-1), "negative"),
        (named(Burst, period=10, length=5, count=0), "number of occurrences"),
        (named(Burst, period=10, length=5, count=10**9), "number of occurrences"),
        (named(VariableRate, step=0, rate=Constant(1.0)), "step"),
        (named(VariableRate, step=1, rate=Constant(float("inf"))), "bounds"),
        (named(VariableRate, step=1, rate=Constant(-1.0)), "number of occurrences"),
        (named(VariableRate, step=1, rate=Constant(1.5)), "in a picosecond"),
        (named(VariableRate, step=1, rate=Constant(1.0), max_increase=-1.0), "change"),
        (named(VariableRate, step=1, rate=Constant(1.0), scenario=Scenario(clock="x")), "clock 'x' is not defined"),
        (named(VariableRate, step=1, rate=Constant(1.0), scenario=Scenario(clock="steps", recurrence=0)), "recurrence"),
        (curve((2, 6, None), (3, None, 10)), "contradict"),
        (curve((2, None, None)), "no borders"),
        (curve((2, -1, None)), "negative"),
        (named(Custom), "does not say when"),
    ],
)
@pytest.mark.parametrize("mode", [Mode.SAMPLED, Mode.WORST])
def test_what_cannot_be_simulated_is_refused_with_a_reason(stimulus, text, mode):
    with pytest.raises(UnknownError, match=text):
        start(stimulus, mode)
