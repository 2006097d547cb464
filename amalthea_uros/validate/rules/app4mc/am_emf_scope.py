"""Ambiguous object name."""

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
        yield f"{unique_name(element)!r} identifies {len(same)} objects"


RULE = ModelRule(
    id="AM-EMF-SCOPE",
    title="ambiguous object name",
    severity=Severity.ERROR,
    target=IReferable,
    check=_check,
    among=lambda context: context.namesakes,
    rationale="References identify objects by name and class across all files of the model, so references to these objects "
    "are ambiguous. APP4MC's validation also reports it.",
    remedy="Give each object of a class a unique name.",
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
