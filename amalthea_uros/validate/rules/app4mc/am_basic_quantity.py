"""Quantity without a unit."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Quantity
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Quantity, context: Context) -> Iterator[str]:
    if getattr(element, "unit", None) in (None, "_undefined_"):
        yield f"the {type(element).__name__} has no unit"


RULE = ModelRule(
    id="AM-Basic-Quantity",
    title="quantity without a unit",
    severity=Severity.ERROR,
    target=Quantity,
    check=_check,
    rationale="A value without a unit is meaningless, even if it is 0. APP4MC's validation also reports it.",
    remedy="Add the unit.",
    fails="""
<swModel>
  <labels name="L">
    <size value="4"/>
  </labels>
</swModel>
""",
    edits={'value="4"': 'value="4" unit="B"'},
)
