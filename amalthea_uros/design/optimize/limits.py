"""Limits of a design beside those of its model, written as `OBJECT.QUANTITY<=VALUE`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.design.changes.change import split_target
from amalthea_uros.design.optimize.problem import Feasibility
from amalthea_uros.design.optimize.quantities import Amount, Dimension, Figures, Range, check_quantity, dimension
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.verdict import Verdict, decide
from amalthea_uros.perf.system import System
from amalthea_uros.units import parse_time

FORM, EXAMPLE = "OBJECT.QUANTITY<=VALUE", "factor-to-output.max_reduced_reaction_time<=11ms"

_FEASIBLE = {Verdict.MET: Feasibility.YES, Verdict.MISSED: Feasibility.NO, Verdict.UNKNOWN: Feasibility.UNKNOWN}
_LIMIT = re.compile(r"(?P<target>.+?)\s*(?P<sign><=|<)\s*(?P<value>[^<>=]+)", re.DOTALL)
_PERCENT = re.compile(r"(\d+(?:\.\d+)?)\s*%", re.ASCII)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """A greatest value of a quantity of a chain, process or core.

    Attributes
    ----------
    maximum : in picoseconds, or as a share
    is_below : whether the maximum itself is too much
    reason : what it is for, if the user did not state it
    """

    object: str
    quantity: str
    maximum: Amount
    is_below: bool = False
    reason: str = ""

    @property
    def target(self) -> str:
        """The object and the quantity."""
        return f"{self.object}.{self.quantity}"

    def range(self, analysis: Analysis, figures: Figures) -> Range:
        """The range of the limited quantity."""
        return figures.range(analysis, self.object, self.quantity)

    def verdict(self, found: Range) -> Feasibility:
        """Whether it holds for certain."""
        return _FEASIBLE[decide(found.upper, found.lower, self._allows)]

    def _allows(self, value: Amount) -> bool:
        return value < self.maximum if self.is_below else value <= self.maximum


def parse_limit(text: str) -> Limit:
    """A limit written as `OBJECT.QUANTITY<=VALUE`, or with `<`; a load is limited by a percentage.

    Raises
    ------
    InvalidArgumentError : the text is not of this form.
    """
    match = _LIMIT.fullmatch(text.strip())
    if match is None:
        raise InvalidArgumentError(f"{text!r} is not of the form {FORM}; an example: {EXAMPLE}")
    name, quantity = split_target(match["target"], text, FORM, EXAMPLE)
    try:
        maximum = _amount(match["value"], quantity)
    except ValueError as error:
        raise InvalidArgumentError(f"{text}: {error}") from None
    return Limit(object=name, quantity=quantity, maximum=maximum, is_below=match["sign"] == "<")


def check_limit(limit: Limit, system: System) -> None:
    """Refuse a limit of what a system does not have; raises InvalidArgumentError."""
    check_quantity(system, limit.object, limit.quantity, limit.target)


def _amount(text: str, quantity: str) -> Amount:
    if dimension(quantity) is Dimension.TIME:
        return parse_time(text)
    match = _PERCENT.fullmatch(text.strip())
    if match is None:
        raise ValueError(f"{text.strip()!r} is not a percentage such as '70%'")
    return Fraction(match[1]) / 100
