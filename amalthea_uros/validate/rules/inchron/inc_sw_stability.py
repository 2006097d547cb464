"""Label or label access with data stability."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Label, LabelAccess
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: Nothing is protected, or another object says so.
_NOT_STATED = (None, "_undefined_", "inherited", "noProtection")


def _check(element: Label | LabelAccess, context: Context) -> Iterator[str]:
    if element.data_stability not in _NOT_STATED:
        owner = f"label {element.name or ''!r}" if isinstance(element, Label) else "label access"
        yield f"the data stability {str(element.data_stability)!r} of the {owner} is ignored by am2inc"


RULE = ModelRule(
    id="INC-SW-STABILITY",
    title="label or label access with data stability",
    severity=Severity.WARNING,
    target=(Label, LabelAccess),
    check=_check,
    rationale="am2inc silently ignores the data stability, so values can change between two accesses of a job.",
    remedy="Model the protection, e.g. with semaphores or copies of the label, or do not rely on it after the import.",
    fails="""
<swModel>
  <labels name="L" dataStability="automaticProtection"/>
</swModel>
""",
    edits={'dataStability="automaticProtection"': 'dataStability="noProtection"'},
)
