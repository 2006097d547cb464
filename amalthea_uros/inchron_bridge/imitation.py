"""A project with the errors of INCHRON's importer, to compare it with one that the importer made of the same model."""

from __future__ import annotations

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.values import NO_LIMIT, time, time_of
from amalthea_uros.inchron_bridge.tables.requirements import CHAIN_REQUIREMENT
from amalthea_uros.inchron_bridge.tables.stimuli import GENERATOR


def imitate(model: ProjectObject, version: str) -> tuple[Finding, ...]:
    """Change a project to what the importer writes of a model of an AMALTHEA version where that is not what the model says.

    Returns
    -------
    The changes.
    """
    with_relations = version == "1.2.0"
    changes = dict.fromkeys(filter(None, [_imitated(item, with_relations) for item in model.walk()]))
    return tuple(Finding("INC010", Severity.WARNING, f"{what}, as INCHRON's importer writes it") for what in changes)


def _imitated(item: ProjectObject, with_relations: bool) -> str | None:
    """The change of an object, None if it stays (am2inc, activityGraph.cpp, swModel.cpp, stimuliModel.cpp and constraintsModel.cpp)."""
    match item.kind:
        case "TimeDistribution" if item["type"] == "Beta":
            item["type"] = "Max"
            return "a beta distribution, written as its upper bound"
        case "TimeDistribution" if item["type"] == "Mean":
            item["mean"]["value"] = (item["max"]["value"] - item["min"]["value"]) // 2
            return "bounds without a shape, written with half of their distance as their mean"
        case "CounterModification" if item["type"] == "Set":
            item["value"] = 1
            return "a counter that is set, written with the usual step as its value"
        case "ModeGroupExpression" | "ModeGroupComparison" | "ValueExpression" | "ValueComparison" if (
            item["relationalOperator"] != "eq" and not with_relations
        ):
            item["relationalOperator"] = "eq"
            return "a relation other than equal, written as an equality"
        case kind if kind == GENERATOR and item["relative"] and item["variation"]["type"] == "Normal":
            bounds = [time_of(item["variation"][end]) or 0 for end in ("min", "max")]
            if any(bounds):
                for end, bound in zip(("min", "max"), bounds, strict=True):
                    item["variation"][end] = time(bound + (time_of(item["period"]) or 0))
                return "a normally distributed distance, written with its bounds as those of the deviation"
        case kind if kind == CHAIN_REQUIREMENT and not item["orSemanticsStart"]:
            if not item["evaluate"] or time_of(item["interval"]["upperLimit"]) == NO_LIMIT:
                item["evaluate"], item["interval"]["upperLimit"] = True, time(0)
                return "a limit without a maximum, written with a maximum of 0"
    return None
