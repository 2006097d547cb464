"""Object without a name."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IReferable
from amalthea_uros.validate.content import new_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: IReferable, context: Context) -> Iterator[str]:
    if not element.name:
        yield f"the {type(element).__name__} has no name"


def _fix(element: IReferable, context: Context) -> bool:
    # Any name is safe: nothing can refer to an object without a name.
    element.name = new_name(type(element).__name__, type(element), context)
    return True


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/IReferable.name",
    title="object without a name",
    severity=Severity.ERROR,
    target=IReferable,
    check=_check,
    fix=_fix,
    rationale="References cannot target the object, and reports cannot name it. APP4MC's validation also reports it.",
    remedy="Give the object a name.",
    fails="""
<swModel>
  <tasks/>
</swModel>
""",
    edits={"<tasks": '<tasks name="T"'},
)
