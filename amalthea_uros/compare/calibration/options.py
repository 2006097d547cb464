"""How measured values become those of a description."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from amalthea_uros.errors import InvalidArgumentError


class Form(StrEnum):
    """What is written for measured execution times: bounds, bounds with the mean, or a histogram."""

    BOUNDS = "bounds"
    MEAN = "mean"
    HISTOGRAM = "histogram"


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationOptions:
    """How measured values become those of a description.

    Attributes
    ----------
    margin : by which share measured minima are lowered and maxima raised, for bounds
    tighten : whether values of the description that are wider than the measurement are narrowed
    judge_on : the share of the values, the last ones, that are not used, but must be within what is written
    """

    form: Form = Form.BOUNDS
    margin: Fraction = Fraction(1, 5)
    tighten: bool = False
    judge_on: Fraction = Fraction(0)

    def __post_init__(self) -> None:
        if self.margin < 0:
            raise InvalidArgumentError(f"the margin {float(self.margin):.4g} is negative; expected 0 or more, e.g. 20%")
        if not 0 <= self.judge_on < 1:
            raise InvalidArgumentError(
                f"cannot judge on {float(self.judge_on):.4g} of the values; expected less than all, e.g. 30%"
            )
