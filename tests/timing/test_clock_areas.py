"""Crossings of the integral of a clock's frequency: the documented examples, and the definition."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.stimuli import ClockFunction, ClockStep, ClockSteps, Curve
from amalthea_uros.timing.event_models.clock_areas import CurveArea, clock_area
from amalthea_uros.units import SECOND


def steps(*pairs, period=None):
    return ClockSteps(
        name="steps", steps=tuple(ClockStep(time=time, frequency=Fraction(hertz)) for time, hertz in pairs), period=period
    )


def function(curve, period, lowest, swing, shift=0):
    return ClockFunction(name="curve", curve=curve, period=period, lowest=Fraction(lowest), swing=Fraction(swing), shift=shift)


def seconds(clock, *areas):
    return [clock_area(clock).first_time(Fraction(area)) / SECOND for area in areas]


def test_the_documented_step_list_crosses_every_2_at_3_to_9_seconds():
    clock = steps((2 * SECOND, 2), (3 * SECOND, 3), (5 * SECOND, 2), (6 * SECOND, 1), (8 * SECOND, 2))
    assert seconds(clock, *range(2, 15, 2)) == pytest.approx([3, 11 / 3, 13 / 3, 5, 6, 8, 9], abs=1e-12)


def test_the_documented_sine_crosses_2_and_4():
    clock = function(Curve.SINE, 10 * SECOND, lowest=1, swing=4, shift=2 * SECOND)
    assert seconds(clock, 2, 4) == pytest.approx([1.298, 2.066], abs=5e-4)


def test_the_documented_triangle_crosses_2_and_4():
    # The frequency is 2 Hz + t Hz/s at first: the area is 2 t + t**2 / 2.
    clock = function(Curve.TRIANGLE, 8 * SECOND, lowest=1, swing=4, shift=SECOND)
    assert seconds(clock, 2, 4) == pytest.approx([2 * 2**0.5 - 2, 2 * 3**0.5 - 2], abs=1e-12)
    assert seconds(clock, 2, 4) == pytest.approx([0.828, 1.464], abs=5e-4)


def test_the_documented_triangle_of_50_hertz():
    clock = function(Curve.TRIANGLE, 2 * SECOND, lowest=45, swing=10)
    assert seconds(clock, 0.0833, 2.0833, 4.0833) == pytest.approx([1.666e-3, 41.49e-3, 81.01e-3], abs=5e-6)


def test_a_constant_frequency_crosses_at_its_period():
    for clock in (
        steps((0, 3)),
        steps((0, 3), period=7),
        function(Curve.SINE, SECOND, 3, 0),
        function(Curve.TRIANGLE, SECOND, 3, 0),
    ):
        assert [clock_area(clock).first_time(Fraction(area)) for area in (1, 2, 3)] == [333333333334, 666666666667, SECOND]
        assert clock_area(clock).first_time(Fraction(1), time_base=3) == SECOND


def test_a_clock_that_stands_still_reaches_nothing():
    assert clock_area(steps()).first_time(Fraction(1)) is None
    assert clock_area(steps((0, 0), period=SECOND)).first_time(Fraction(1)) is None
    assert clock_area(function(Curve.SINE, SECOND, 0, 0)).first_time(Fraction(1)) is None
    stops = clock_area(steps((0, 2), (SECOND, 0)))
    assert stops.first_time(Fraction(2)) == SECOND
    assert stops.first_time(Fraction(2) + Fraction(1, 1000)) is None


def test_steps_repeat_and_are_0_before_the_first():
    clock = clock_area(steps((6, SECOND), period=10))
    # An area of 1 for each picosecond from 6 to 10 of each period.
    assert [clock.first_time(Fraction(area)) for area in range(1, 10)] == [7, 8, 9, 10, 17, 18, 19, 20, 27]


FUNCTIONS = st.builds(
    function,
    st.sampled_from(Curve),
    period=st.integers(4, 10**13),
    lowest=st.integers(0, 10**6),
    swing=st.integers(1, 10**6),
    shift=st.integers(-(10**13), 10**13),
)


@given(FUNCTIONS, st.fractions(0, 1).filter(bool), st.integers(1, 3))
def test_a_crossing_is_the_first_time_unit_at_which_the_area_is_reached(clock, part, time_base):
    area = clock_area(clock)
    assert isinstance(area, CurveArea)
    wanted = area.of_period * part
    found = area.first_time(wanted, time_base)
    assert area.area(Fraction(found - 1, time_base)) < wanted <= area.area(Fraction(found, time_base))


@given(FUNCTIONS)
def test_the_area_of_a_period_is_that_of_the_middle_frequency(clock):
    middle = clock.lowest + clock.swing / 2
    assert clock_area(clock).of_period == middle * clock.period / SECOND


@given(FUNCTIONS, st.integers(1, 3))
def test_areas_of_later_periods_follow_a_period_later(clock, rounds):
    area = clock_area(clock)
    wanted = area.of_period / 3
    assert area.first_time(wanted + rounds * area.of_period) == area.first_time(wanted) + rounds * clock.period


def test_half_a_sine_covers_its_amplitude_times_period_over_pi():
    area = clock_area(function(Curve.SINE, SECOND, lowest=0, swing=2))
    assert float(area.area(Fraction(SECOND, 2))) == pytest.approx(0.5 + 1 / 3.141592653589793, rel=1e-15)


@pytest.mark.parametrize(
    "clock", [steps((0, 1), period=0), steps((0, -1)), function(Curve.SINE, -1, 1, 1), function(Curve.SINE, 1, -1, 5)]
)
def test_invalid_clocks_are_refused(clock):
    with pytest.raises(UnknownError, match=r"clock '(steps|curve)' is"):
        clock_area(clock)
