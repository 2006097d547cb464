"""A question about the unit is asked only where a clock can hardly be meant."""

from fractions import Fraction

import pytest

from amalthea_uros.timing.activation.load import unit_hint


@pytest.mark.parametrize(
    ("load", "frequency", "is_asked"),
    [
        (40_000, Fraction(600), True),  # 4,000,000 % at 600 Hz
        (Fraction(11, 10), Fraction(600), False),  # overloaded, but by little: somebody may simulate slow motion
        (40_000, Fraction(600 * 10**6), False),  # 600 MHz: the demand is what is wrong
        (40_000, None, False),
    ],
)
def test_a_slow_clock_with_an_absurd_load(load, frequency, is_asked):
    hint = unit_hint(load, frequency)
    assert hint == ("its clock has 600 Hz: is that the unit, or kHz or MHz?" if is_asked else "")
