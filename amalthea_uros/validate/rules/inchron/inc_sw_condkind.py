"""Unsupported condition."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    Condition,
    ConditionConjunction,
    EnumMode,
    ModeLabel,
    ModeLabelCondition,
    ModeValueCondition,
    NumericMode,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule


def _check(element: Condition, context: Context) -> Iterator[str | Downgraded]:
    if isinstance(element, ModeValueCondition):
        if element.label is None:
            yield "the condition has no mode label"
    elif isinstance(element, ModeLabelCondition):
        first, second = element.label1, element.label2
        if first is None or second is None:
            yield "the condition has fewer than two mode labels"
        elif first.unresolved is None and second.unresolved is None and not _is_of_same_kind(first, second):
            yield Downgraded(f"the mode labels {first.name or ''!r} and {second.name or ''!r} have modes of different kinds")
    else:
        message = f"the {type(element).__name__} does not compare modes"
        yield message if isinstance(element.container, ConditionConjunction) else Downgraded(message)


def _is_of_same_kind(first: ModeLabel, second: ModeLabel) -> bool:
    """Whether both have an enum mode or both a numeric one; am2inc reads a first label without a mode as numeric."""
    return isinstance(second.mode, EnumMode if isinstance(first.mode, EnumMode) else NumericMode)


RULE = ModelRule(
    id="INC-SW-CONDKIND",
    title="unsupported condition",
    severity=Severity.ERROR,
    target=Condition,
    check=_check,
    rationale="am2inc crashes with a segmentation fault if a mode label is missing, or if a conjunction contains a condition "
    "that does not compare modes. Elsewhere it silently drops such a condition. If two modes are of different kinds, it drops "
    "the second label and prints a warning.",
    remedy="Compare a mode label with a value, or with a label whose mode is of the same kind (enum or numeric).",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Switch">
        <entries name="e">
          <condition>
            <entries xsi:type="am:ConditionConjunction">
              <entries xsi:type="am:ChannelFillCondition" channel="C?type=Channel" relation="EQUAL" fillLevel="1"/>
            </entries>
          </condition>
        </entries>
      </items>
    </activityGraph>
  </runnables>
  <channels name="C"/>
</swModel>
""",
    edits={
        """<entries xsi:type="am:ConditionConjunction">
              <entries xsi:type="am:ChannelFillCondition" channel="C?type=Channel" relation="EQUAL" fillLevel="1"/>
            </entries>""": '<entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="1"/>',
        '<channels name="C"/>': """<modes xsi:type="am:NumericMode" name="M"/>
  <modeLabels name="L" mode="M?type=NumericMode"/>""",
    },
)
