"""Name that is not unique."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea, IReferable
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: IReferable, context: Context) -> Iterator[str]:
    same = context.namesakes.get(element)
    if same is not None and not isinstance(element, Amalthea):
        yield f"there are {len(same)} objects {unique_name(element)!r}"


RULE = ModelRule(
    id="INC-IO-NAME",
    title="name that is not unique",
    severity=Severity.WARNING,
    target=IReferable,
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
