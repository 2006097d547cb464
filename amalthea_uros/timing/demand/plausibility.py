"""Clocks that nobody can mean."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.units import Frequency, frequency_text

#: A load of ten cores is no mistake of a design.
_ABSURD_LOAD = 10
#: No controller that executes tasks is as slow: a clock below 1 kHz is one whose prefix is missing.
_SLOWEST = 1000


def unit_hint(load: Fraction | int, frequency: Frequency | None) -> str:
    """A question about the unit of a clock with which a core has an absurd load; "" for any other core."""
    if frequency is None or frequency >= _SLOWEST or load < _ABSURD_LOAD:
        return ""
    return f"its clock has {frequency_text(frequency)}: is that the unit, or kHz or MHz?"
