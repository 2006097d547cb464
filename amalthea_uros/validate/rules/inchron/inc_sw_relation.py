"""Relation other than EQUAL."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ModeCondition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel


def _check(element: ModeCondition, context: Context) -> Iterator[str]:
    if element.relation != "EQUAL" and metamodel(element) != "1.2.0":
        yield "the relation of the condition is changed to EQUAL by am2inc"


RULE = ModelRule(
    id="INC-SW-RELATION",
    title="relation other than EQUAL",
    severity=Severity.WARNING,
    target=ModeCondition,
    check=_check,
    rationale="am2inc silently changes every relation to EQUAL in models of AMALTHEA 2.0 and newer.",
    remedy="Rewrite the condition with EQUAL only.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Switch">
        <entries name="e">
          <condition>
            <entries xsi:type="am:ModeValueCondition" relation="LESS_THAN" value="1"/>
          </condition>
        </entries>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={'relation="LESS_THAN"': 'relation="EQUAL"'},
)
