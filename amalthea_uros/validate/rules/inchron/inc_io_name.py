"""Name that is not unique."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Element, context: Context) -> Iterator[str]:
    if element.is_referable and not isinstance(element, Amalthea):
        name = unique_name(element)
        if context.names[name] > 1:
            yield f"there are {context.names[name]} objects {name!r}"


RULE = ModelRule(
    id="INC-IO-NAME",
    title="name that is not unique",
    severity=Severity.WARNING,
    target=Element,
    check=_check,
    rationale="A reference picks one of the objects; am2inc keeps all of them under the same name.",
    remedy="Give each object of a class a name of its own.",
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
