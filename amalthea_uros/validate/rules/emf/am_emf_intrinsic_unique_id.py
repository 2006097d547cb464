"""Duplicate name in a file."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IReferable
from amalthea_uros.validate.content import new_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: IReferable, context: Context) -> Iterator[str]:
    if element.name and _has_namesake_in_file(element, context):
        yield f"{element.qualified_name!r} is the name of several {type(element).__name__} objects in this file"


def _has_namesake_in_file(element: IReferable, context: Context) -> bool:
    document = element.document
    return any(other is not element and other.document is document for other in context.namesakes.get(element, ()))


def _fix(element: IReferable, context: Context) -> bool:
    # References resolve to the first object of a name, so the others can be renamed.
    if element in context.referred or context.namesakes[element][0] is element:
        return False
    element.name = new_name(element.name or "", type(element), context)
    return True


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/unique-id",
    title="duplicate name in a file",
    severity=Severity.ERROR,
    target=IReferable,
    check=_check,
    among=lambda context: context.namesakes,
    fix=_fix,
    rationale="References identify objects by class and name, and can reach only one of these objects. APP4MC's validation "
    "also reports it.",
    remedy="Give each object a unique name, or move one of them to another namespace.",
    fails="""
<swModel>
  <tasks name="T"/>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T"/>
  <isrs name="T"/>
</swModel>
""",
)
