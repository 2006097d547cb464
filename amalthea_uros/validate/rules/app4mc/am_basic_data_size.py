"""Size of zero or less."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractMemoryElement
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: AbstractMemoryElement, context: Context) -> Iterator[str]:
    if element.size is not None and (element.size.value or 0) <= 0:
        yield f"the size of {element.name!r} is {element.size.value or 0}, but must be greater than 0"


RULE = ModelRule(
    id="AM-Basic-Data-Size",
    title="size of zero or less",
    severity=Severity.ERROR,
    target=AbstractMemoryElement,
    check=_check,
    rationale="An object in memory occupies at least one bit. APP4MC's validation also reports it.",
    remedy="Set a size greater than 0, or remove the size.",
    fails="""
<swModel>
  <labels name="L">
    <size value="0" unit="B"/>
  </labels>
</swModel>
""",
    edits={'value="0"': 'value="4"'},
)
