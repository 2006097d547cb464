"""Loads of cores and buses as pages and pictures show them."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.units import Rounding, number_text, rounded


def load_text(load: Fraction, rounding: Rounding = Rounding.NEAREST) -> str:
    """A load in percent with four significant digits; bounds are rounded so that they remain bounds."""
    return f"{number_text(rounded(load * 100, rounding, 100))} %"
