"""Names of objects, and references by name."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.content import new_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule, repair_of


@model_rule("AM-EMF-INTRINSIC/IReferable.name", am.IReferable)
def _check_ireferable_name(element: am.IReferable, context: Context) -> Iterator[str]:
    if not element.name:
        yield f"the {type(element).__name__} has no name"


@repair_of("AM-EMF-INTRINSIC/IReferable.name")
def _fix_ireferable_name(element: am.IReferable, context: Context) -> bool:
    # Any name is safe: nothing can refer to an object without a name.
    element.name = new_name(type(element).__name__, type(element), context)
    return True


@model_rule("AM-EMF-INTRINSIC/unique-id", am.IReferable, among=lambda context: context.namesakes)
def _check_unique_id(element: am.IReferable, context: Context) -> Iterator[str]:
    if element.name and _has_namesake_in_file(element, context):
        yield f"{element.qualified_name!r} is the name of several {type(element).__name__} objects in this file"


def _has_namesake_in_file(element: am.IReferable, context: Context) -> bool:
    document = element.document
    return any(other is not element and other.document is document for other in context.namesakes.get(element, ()))


@repair_of("AM-EMF-INTRINSIC/unique-id")
def _fix_unique_id(element: am.IReferable, context: Context) -> bool:
    # References resolve to the first object of a name, so the others can be renamed.
    if element in context.referred or context.namesakes[element][0] is element:
        return False
    element.name = new_name(element.name or "", type(element), context)
    return True


@model_rule("AM-EMF-INTRINSIC/proxy-resolves", Element, among=lambda context: context.dangling, is_about_files=True)
def _check_proxy_resolves(element: Element, context: Context) -> Iterator[str]:
    for name, text in context.dangling.get(element, ()):
        yield f"{name} refers to {text!r}, which is not defined"
