"""Branches without a probability."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProbabilitySwitch
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule


def _check(element: ProbabilitySwitch, context: Context) -> Iterator[str]:
    if element.entries and not any((entry.probability or 0) > 0 for entry in element.entries):
        yield "no branch has a probability greater than 0"


RULE = ModelRule(
    id="TIM-WEIGHTS",
    title="branches without a probability",
    severity=Severity.WARNING,
    target=ProbabilitySwitch,
    check=_check,
    rationale="If all probabilities are 0, no branch can be chosen.",
    remedy="Give at least one branch a probability greater than 0.",
    fails=runnable_with("""
<items xsi:type="am:ProbabilitySwitch">
  <entries probability="0"/>
</items>
"""),
    edits={'probability="0"': 'probability="0.5"'},
)
