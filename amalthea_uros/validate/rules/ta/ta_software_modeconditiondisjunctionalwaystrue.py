"""Mode condition that is always true."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ConditionDisjunction, EnumMode, ModeConditionDisjunction, ModeLabel
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.ta._modes import by_label


def _check(element: ConditionDisjunction | ModeConditionDisjunction, context: Context) -> Iterator[str]:
    # Only single conditions count, not those within conjunctions.
    for label, (accepted, rejected) in by_label(element.entries).items():
        literals = _literals(label)
        if literals and literals <= set(accepted):
            yield f"{label.name!r} may have any of its literals"
        for literal in accepted:
            if literal in rejected:
                yield f"{label.name!r} may equal {literal!r} or differ from it"


def _literals(label: ModeLabel) -> set[str | None]:
    return {literal.name for literal in label.mode.literals} if isinstance(label.mode, EnumMode) else set()


RULE = ModelRule(
    id="TA-Software-ModeConditionDisjunctionAlwaysTrue",
    title="mode condition that is always true",
    severity=Severity.WARNING,
    target=(ConditionDisjunction, ModeConditionDisjunction),
    check=_check,
    rationale="The condition has no effect. APP4MC's validation also reports it.",
    remedy="Remove the condition, or accept fewer literals.",
    fails="""
<swModel>
  <runnables name="R">
    <executionCondition>
      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="on"/>
      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="off"/>
    </executionCondition>
  </runnables>
  <modes xsi:type="am:EnumMode" name="M">
    <literals name="on"/>
    <literals name="off"/>
  </modes>
  <modeLabels name="L" mode="M?type=EnumMode"/>
</swModel>
""",
    edits={'      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="off"/>\n': ""},
)
