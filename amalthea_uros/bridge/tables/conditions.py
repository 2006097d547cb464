"""Conditions and assignments of modes.

AMALTHEA nests conditions, conjunctions and disjunctions as objects; until 1.2 under other names.
"""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.basics.codecs import PLAIN, Codec, build_reason, enumeration, extract_reason, reference
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable, parts
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import conditions as perf

_RELATION = enumeration(
    {
        perf.Relation.EQUAL: am.RelationalOperator.EQUAL,
        perf.Relation.NOT_EQUAL: am.RelationalOperator.NOT_EQUAL,
        perf.Relation.LESS: am.RelationalOperator.LESS_THAN,
        perf.Relation.LESS_OR_EQUAL: am.RelationalOperator.LESS_THAN_OR_EQUAL,
        perf.Relation.GREATER: am.RelationalOperator.GREATER_THAN,
        perf.Relation.GREATER_OR_EQUAL: am.RelationalOperator.GREATER_THAN_OR_EQUAL,
    }
)
_MODE_LABEL = reference(ObjectKind.MODE_LABEL)


class _Comparisons(ClassTable):
    """Comparisons; what is not stated completely, or is of another class, can be true or false."""

    def build(self, item: Any, context: Building) -> Any:
        if isinstance(item, perf.Undecided):
            return am.ModeValueCondition(custom_properties=build_reason(item.reason))
        return super().build(item, context)

    def extract(self, element: Element, context: Extracting) -> Any:
        reason = extract_reason(element) if isinstance(element, am.ModeValueCondition) else None
        found = super().extract(element, context) if reason is None else None
        return found or perf.Undecided(reason=reason or f"a {type(element).__name__} that is incomplete or not supported")


_COMPARISONS: ClassTable = _Comparisons(
    ClassEntry(perf.ModeValueIs, am.ModeValueCondition, label=_MODE_LABEL, relation=_RELATION, value=PLAIN),
    ClassEntry(
        perf.ModeLabelsAre,
        am.ModeLabelCondition,
        first=("label1", _MODE_LABEL),
        relation=_RELATION,
        second=("label2", _MODE_LABEL),
    ),
    ClassEntry(
        perf.ChannelFillIs, am.ChannelFillCondition, channel=reference(ObjectKind.DATA), relation=_RELATION, level="fill_level"
    ),
)


def _build(condition: perf.Condition, context: Building) -> Element:
    is_new = context.is_at_least(2)
    conjunction = am.ConditionConjunction if is_new else am.ModeConditionConjunction
    entries: list[Any] = []
    for alternative in condition.alternatives:
        comparisons = [_COMPARISONS.build(comparison, context) for comparison in alternative]
        entries.append(comparisons[0] if len(comparisons) == 1 else conjunction(entries=comparisons))
    return (am.ConditionDisjunction if is_new else am.ModeConditionDisjunction)(entries=entries)


def _extract(value: Element, context: Extracting, _element: Element) -> perf.Condition:
    alternatives = []
    for entry in getattr(value, "entries", ()):
        is_several = isinstance(entry, am.ConditionConjunction | am.ModeConditionConjunction)
        alternatives.append(_COMPARISONS.extract_all(entry.entries if is_several else [entry], context))
    return perf.Condition(tuple(alternatives))


CONDITION = Codec(_build, _extract)

_ASSIGNMENTS = ClassTable(ClassEntry(perf.ModeAssignment, am.ModeAssignment, label=_MODE_LABEL, value=PLAIN))
_ENTRIES = parts(_ASSIGNMENTS)

#: The list of assignments is an object of its own.
ASSIGNMENTS = Codec(
    lambda items, context: am.ModeValueList(entries=_ENTRIES.build(items, context)),
    lambda value, context, element: _ENTRIES.extract(value.entries, context, element),
)
