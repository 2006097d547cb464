"""Unresolved reference."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Element, context: Context) -> Iterator[str]:
    for name, text in context.dangling.get(element, ()):
        yield f"{name} refers to {text!r}, which is not defined"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/proxy-resolves",
    title="unresolved reference",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
    among=lambda context: context.dangling,
    rationale="The target is not defined in any of the files. APP4MC's validation also reports it.",
    remedy="Correct the name, or add the file that defines the target.",
    fails="""
<swModel>
  <tasks name="T" stimuli="S?type=PeriodicStimulus"/>
</swModel>
""",
    edits={
        "</swModel>": """</swModel>
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>""",
    },
    is_about_files=True,
)
