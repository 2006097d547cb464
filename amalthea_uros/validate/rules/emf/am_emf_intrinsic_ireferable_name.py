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
    # Any name will do: without one nothing can refer to it.
    element.name = new_name(type(element).__name__, type(element), context)
    return True


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/IReferable.name",
    title="object without a name",
    severity=Severity.ERROR,
    target=IReferable,
    check=_check,
    fix=_fix,
    rationale="Nothing can refer to it, and no report can name it. APP4MC reports it when it validates the model.",
    remedy="Give it a name.",
    fails="""
<swModel>
  <tasks/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
)
