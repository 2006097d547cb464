"""Settings that mean nothing are refused, instead of turning time around."""

from fractions import Fraction

import pytest

from amalthea_uros import Duration, Settings


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"scale": Fraction(0)}, "scale: 0 is not positive"),
        ({"frequencies": {"core": Fraction(-1)}}, "core: -1 is not positive"),
        ({"growth": Fraction(-1)}, "growth: -1 is negative"),
        ({"factors": {"T": Fraction(-1)}}, "T: -1 is negative"),
        ({"phases": {"S": Duration(-5)}}, "S: -5 is negative"),
    ],
)
def test_a_number_out_of_range(settings, message):
    with pytest.raises(ValueError, match=message):
        Settings(**settings)
