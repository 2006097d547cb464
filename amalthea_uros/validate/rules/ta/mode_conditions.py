"""Conditions on modes that are always or never true."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ConditionConjunction,
    ConditionDisjunction,
    EnumMode,
    ModeConditionConjunction,
    ModeConditionDisjunction,
    ModeLabel,
    ModeValueCondition,
    RelationalOperator,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.wording import joined


def by_label(conditions: Iterable[Element]) -> dict[ModeLabel, tuple[dict[str, None], dict[str, None]]]:
    """The literals that each mode label is compared with, for equality and for inequality."""
    found: dict[ModeLabel, tuple[dict[str, None], dict[str, None]]] = {}
    for condition in conditions:
        if not isinstance(condition, ModeValueCondition) or condition.label is None or condition.value is None:
            continue
        if isinstance(condition.label.mode, EnumMode) and condition.relation in _RELATIONS:
            found.setdefault(condition.label, ({}, {}))[_RELATIONS.index(condition.relation)][condition.value] = None
    return found


_RELATIONS = (RelationalOperator.EQUAL, RelationalOperator.NOT_EQUAL)


def _check_conjunction(element: ConditionConjunction | ModeConditionConjunction, context: Context) -> Iterator[str]:
    for label, (required, excluded) in by_label(element.entries).items():
        if len(required) > 1:
            yield f"{label.name!r} must equal {joined(map(repr, required))} at the same time"
        if len(excluded) > 1:
            # With a third literal this can be true, but APP4MC reports it anyway.
            yield f"{label.name!r} must differ from {joined(map(repr, excluded))}"
        for literal in required:
            if literal in excluded:
                yield f"{label.name!r} must both equal and differ from {literal!r}"


def _check_disjunction(element: ConditionDisjunction | ModeConditionDisjunction, context: Context) -> Iterator[str]:
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


RULES = (
    ModelRule(
        id="TA-Software-ModeConditionConjunctionAlwaysFalse",
        title="mode condition that is never true",
        severity=Severity.WARNING,
        target=(ConditionConjunction, ModeConditionConjunction),
        check=_check_conjunction,
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
        edits={
            '        <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="off"/>\n': ""
        },
    ),
    ModelRule(
        id="TA-Software-ModeConditionDisjunctionAlwaysTrue",
        title="mode condition that is always true",
        severity=Severity.WARNING,
        target=(ConditionDisjunction, ModeConditionDisjunction),
        check=_check_disjunction,
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
    ),
)
