"""Duplicate name."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import INamespaceMember, IReferable
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: IReferable, context: Context) -> Iterator[str]:
    same = context.namesakes.get(element)
    if same is not None:
        yield f"the name {unique_name(element)!r} is used by {len(same)} objects"
    elif isinstance(element, INamespaceMember) and element.namespace is not None:
        count = context.once(_plain_names)[type(element), element.name]
        if count > 1:
            objects = f"{count} objects of the class {type(element).__name__}"
            yield f"the name {element.name or ''!r} is used by {objects} in different namespaces"


def _plain_names(context: Context) -> Counter[tuple[type[Element], str | None]]:
    """How often a class uses a name, regardless of the namespace."""
    return Counter((type(member), member.name) for member in context.all(INamespaceMember) if isinstance(member, IReferable))


RULE = ModelRule(
    id="INC-IO-NAME",
    title="duplicate name",
    severity=Severity.WARNING,
    target=IReferable,
    check=_check,
    rationale="A reference with this name resolves to only one of the objects, and am2inc writes all of them with the same "
    "name.",
    remedy="Give every object of a class a unique name.",
    fails="""
<swModel>
  <tasks name="T"/>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T"/>
  <tasks name="U"/>
</swModel>
""",
)
