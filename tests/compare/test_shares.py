"""Shares that users give."""

from fractions import Fraction

import pytest

from amalthea_uros.compare.shares import parse_share, parse_tolerance
from amalthea_uros.errors import InvalidArgumentError


@pytest.mark.parametrize(
    ("text", "share"),
    [
        ("20%", Fraction(1, 5)),
        ("20 %", Fraction(1, 5)),
        ("0.2", Fraction(1, 5)),
        (0.2, Fraction(1, 5)),
        ("1e-1", Fraction(1, 10)),
    ],
)
def test_shares_are_exact(text, share):
    assert parse_share(text, "margin") == parse_tolerance(text) == share


@pytest.mark.parametrize("text", ["", "x", "nan", "inf", "1e400", "1e400%", "1e999999999", "1e-999999999", "1/0", "9" * 5000])
def test_what_is_no_share_is_refused_at_once(text):
    with pytest.raises(InvalidArgumentError, match="is not a share"):
        parse_share(text, "margin")
    with pytest.raises(InvalidArgumentError, match="is not a tolerance"):
        parse_tolerance(text)
