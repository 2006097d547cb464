"""Times of callers: with a unit, or refused."""

import dataclasses
from datetime import timedelta
from fractions import Fraction

import pytest

import amalthea_uros as amuros
from amalthea_uros.timing.basics.stated_times import stated_time
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration


@pytest.mark.parametrize("value", ["1.5 ms", Duration.of("1500 us"), Duration(1_500_000_000), timedelta(microseconds=1500)])
def test_the_same_time(value):
    assert stated_time("the period", value) == 3 * MS // 2
    assert amuros.task("A", period=value, wcet="1 ms").period == 3 * MS // 2


def test_numbers_have_a_unit():
    assert stated_time("t", Fraction(3, 2), "ms") == 3 * MS // 2
    assert stated_time("t", 0) == 0
    with pytest.raises(
        amuros.InvalidArgumentError, match=r"A: period: the number 10 has no unit; write a text such as '10 ms', or"
    ):
        amuros.task("A", period=10, wcet="1 ms")
    with pytest.raises(TypeError, match=r"write Duration.of\('10 ms'\)"):
        Duration("10 ms")


def test_arithmetic():
    ten, two = Duration.of("10 ms"), Duration.of("2 ms")
    assert (str(ten + two), str(ten - two), str(3 * two), two < ten) == ("12 ms", "8 ms", "6 ms", True)
    # A result is in picoseconds; it can be stated again.
    worst = amuros.analyze(amuros.taskset([(ten, two)], priorities="rate monotonic"))["T1"].wcrt
    assert amuros.task("B", period=Duration(worst), wcet="1 ms").period == 2 * MS


def test_options_and_settings_take_quantities_with_their_units():
    options = amuros.Options(duration="10 s", traced=("0 s", Duration.of("1 ms")))
    assert (options.duration, options.traced) == (10 * 10**12, (0, 10**9))
    settings = amuros.Settings(frequencies={"Core_0": "300 MHz"}, phases={"cmd_vel": "2 ms"})
    assert (settings.frequencies, settings.phases) == ({"Core_0": 300 * 10**6}, {"cmd_vel": 2 * 10**9})
    with pytest.raises(amuros.InvalidArgumentError, match=r"the number 1\.5 has no unit; write a text such as '1\.5 ms'"):
        amuros.Options(duration=1.5)
    with pytest.raises(amuros.InvalidArgumentError, match=r"the duration: the number 1000000000000 has no unit"):
        amuros.Options(duration=10**12)
    with pytest.raises(amuros.InvalidArgumentError, match=r"the end of the trace: the number 5 has no unit"):
        amuros.Options(duration="1 s", traced=(0, 5))
    with pytest.raises(amuros.InvalidArgumentError, match=r"cmd_vel: the number 5 has no unit"):
        amuros.Settings(phases={"cmd_vel": 5})
    with pytest.raises(
        amuros.InvalidArgumentError, match=r"Core_0: the number 300 has no unit; write a text such as '300 MHz'"
    ):
        amuros.Settings(frequencies={"Core_0": 300})
    # What is kept is known as stated when an object is made of another one.
    assert dataclasses.replace(options, seed=2) == amuros.Options(duration="10 s", seed=2, traced=("0 s", "1 ms"))
    assert dataclasses.replace(settings, growth=Fraction(2)).phases == settings.phases
    with pytest.raises(amuros.InvalidArgumentError, match="Core_0: '300' has no unit"):
        amuros.Settings(frequencies={"Core_0": "300"})
