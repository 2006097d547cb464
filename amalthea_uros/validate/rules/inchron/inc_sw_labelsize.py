"""Label without a size."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Label
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Label, context: Context) -> Iterator[str]:
    if element.size is None:
        yield f"the label {element.name or ''!r} has no size"


RULE = ModelRule(
    id="INC-SW-LABELSIZE",
    title="label without a size",
    severity=Severity.WARNING,
    target=Label,
    check=_check,
    rationale="am2inc silently uses 1 KiB.",
    remedy="Set the size of the label, e.g. 32 bit.",
    fails="""
<swModel>
  <labels name="L"/>
</swModel>
""",
    edits={
        'name="L"/>': """name="L">
    <size value="4" unit="B"/>
  </labels>""",
    },
)
