"""Name that several objects have."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IReferable
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: IReferable, context: Context) -> Iterator[str]:
    same = context.namesakes.get(element)
    if element.name and same is not None:
        yield f"there are {len(same)} objects {unique_name(element)!r}"


RULE = ModelRule(
    id="AM-EMF-SCOPE",
    title="name that several objects have",
    severity=Severity.ERROR,
    target=IReferable,
    check=_check,
    among=lambda context: context.namesakes,
    rationale="In all files of a model together, references find an object by its name and class. "
    "APP4MC reports it when it validates the model.",
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
  <runnables name="T"/>
</swModel>
""",
)
