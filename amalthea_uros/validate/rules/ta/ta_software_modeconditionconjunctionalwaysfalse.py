"""Mode condition that is never true."""

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
            yield f"{label.name!r} must equal {joined(map(repr, required))} at the same time"
        if len(excluded) > 1:
            # With a third literal this can be true, but APP4MC reports it anyway.
            yield f"{label.name!r} must differ from {joined(map(repr, excluded))}"
        for literal in required:
            if literal in excluded:
                yield f"{label.name!r} must both equal and differ from {literal!r}"


RULE = ModelRule(
    id="TA-Software-ModeConditionConjunctionAlwaysFalse",
    title="mode condition that is never true",
    severity=Severity.WARNING,
    target=(ConditionConjunction, ModeConditionConjunction),
    check=_check,
    rationale="Whatever depends on the condition never executes. APP4MC's validation also reports it.",
    remedy="Require at most one literal for each mode label.",
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
    edits={'        <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="off"/>\n': ""},
)
