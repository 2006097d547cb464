"""Conditions that cannot all be true."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ConditionConjunction, ModeConditionConjunction
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._modes import by_label
from amalthea_uros.validate.wording import joined


def _check(element: ConditionConjunction | ModeConditionConjunction, context: Context) -> Iterator[str]:
    for label, (required, excluded) in by_label(element.entries).items():
        if len(required) > 1:
            yield f"{label.name!r} is required to be {joined(map(repr, required))} at once"
        if len(excluded) > 1:
            # With a third literal this can be true; APP4MC reports it all the same.
            yield f"{label.name!r} is required not to be {joined(map(repr, excluded))}"
        for literal in required:
            if literal in excluded:
                yield f"{label.name!r} is required both to be and not to be {literal!r}"


RULE = ModelRule(
    id="TA-Software-ModeConditionConjunctionAlwaysFalse",
    title="conditions that cannot all be true",
    severity=Severity.WARNING,
    target=(ConditionConjunction, ModeConditionConjunction),
    check=_check,
    rationale="What depends on it never happens. APP4MC reports it when it validates the model.",
    remedy="Require one literal of each mode label.",
    fails="""
<swModel>
  <runnables name="R">
    <executionCondition>
      <entries xsi:type="am:ConditionConjunction">
        <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="on"/>
        <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="off"/>
      </entries>
    </executionCondition>
  </runnables>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode"/>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <executionCondition>
      <entries xsi:type="am:ConditionConjunction">
        <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="on"/>
      </entries>
    </executionCondition>
  </runnables>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode"/>
</swModel>
""",
)
