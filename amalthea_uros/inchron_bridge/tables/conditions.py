"""Conditions on modes and counters."""

from __future__ import annotations

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import keep_whole
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.perf import conditions as perf

_RELATIONS = {
    perf.Relation.EQUAL: "eq",
    perf.Relation.NOT_EQUAL: "ne",
    perf.Relation.LESS: "lt",
    perf.Relation.LESS_OR_EQUAL: "le",
    perf.Relation.GREATER: "gt",
    perf.Relation.GREATER_OR_EQUAL: "ge",
}
#: The key of a condition in the comment of what stands for it.
CONDITION = "condition"

_RELATION_OF = {literal: relation for relation, literal in _RELATIONS.items()}


def build_condition(condition: perf.Condition | None, context: Exporting, source: object) -> ProjectObject:
    """A condition of the model; without conjunctions if it cannot be decided by what a project has."""
    made = ProjectObject("Condition", name=numbered("Condition", context))
    context.model.add("globalConditions", made)
    for every in condition.alternatives if condition else ():
        expressions = [_expression(comparison, context) for comparison in every]
        known = [expression for expression in expressions if expression is not None]
        if len(known) < len(every) or not every:
            context.lost(source, "a condition", "it is written without content, so that it is unknown when it is true")
            made["conjunctions"] = []
            keep_whole(made, CONDITION, condition)
            return made
        made.add("conjunctions", ProjectObject("Conjunction", expressions=known))
    return made


def numbered(kind: str, context: Exporting) -> str:
    """The next name of what is numbered over the whole model."""
    context.condition += 1
    return f"{kind}_{context.condition - 1}"


def _expression(comparison: perf.Comparison, context: Exporting) -> ProjectObject | None:
    """None if there is no expression for it."""
    match comparison:
        case perf.ModeValueIs(label=label, relation=relation, value=value):
            operator = _RELATIONS[relation]
            group, counter = context.find("ModeGroup", label), context.find("Counter", label)
            if group is not None:
                mode = next((mode for mode in group["modes"] if mode.name == value), None)
                kind = "ModeGroupExpression"
                return ProjectObject(kind, modeGroup=group, value=mode, relationalOperator=operator) if mode else None
            if counter is not None and (number := whole_number(value)) is not None:
                return ProjectObject("ValueExpression", value=counter, constant=number, relationalOperator=operator)
        case perf.ModeLabelsAre(first=first, relation=relation, second=second):
            operator = _RELATIONS[relation]
            for kind, made, feature in (
                ("ModeGroup", "ModeGroupComparison", "modeGroup"),
                ("Counter", "ValueComparison", "value"),
            ):
                ends = context.find(kind, first), context.find(kind, second)
                if None not in ends:
                    values = {f"{feature}1": ends[0], f"{feature}2": ends[1]}
                    return ProjectObject(made, relationalOperator=operator, **values)
    return None


def whole_number(text: str | None) -> int | None:
    """The number that a text is, if a project can hold it."""
    try:
        number = int(text or "")
    except ValueError:
        return None
    return number if -(2**31) <= number < 2**31 else None


def extract_condition(item: ProjectObject | None, context: Importing) -> perf.Condition | None:
    """The condition; None if it is unknown when it is true."""
    if item is None or not item["conjunctions"]:
        return None if item is None else context.whole(item, CONDITION, (perf.Condition,))
    return perf.Condition(
        tuple(tuple(_comparison(each, context) for each in every["expressions"]) for every in item["conjunctions"])
    )


def _comparison(item: ProjectObject, context: Importing) -> perf.Comparison:
    relation = _RELATION_OF[item["relationalOperator"]]
    match item.kind:
        case "ModeGroupExpression" if item["value"] is not None:
            label = context.name_of("ModeGroup", item["modeGroup"])
            if label is not None:
                return perf.ModeValueIs(label=label, relation=relation, value=item["value"].name)
        case "ValueExpression":
            label = context.name_of("Counter", item["value"])
            if label is not None:
                return perf.ModeValueIs(label=label, relation=relation, value=str(item["constant"]))
        case "ModeGroupComparison" | "ValueComparison":
            kind, feature = ("ModeGroup", "modeGroup") if item.kind == "ModeGroupComparison" else ("Counter", "value")
            first, second = (context.name_of(kind, item[f"{feature}{number}"]) for number in (1, 2))
            if first is not None and second is not None:
                return perf.ModeLabelsAre(first=first, relation=relation, second=second)
    return perf.Undecided(reason=f"the project compares by a {item.kind}")
