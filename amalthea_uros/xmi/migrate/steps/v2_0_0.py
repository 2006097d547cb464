"""0.9.9 -> 1.0.0, without measurements; 1.1.0 -> 1.2.0, positive occurrences; 1.2.0 -> 2.0.0, scheduling as data."""

from __future__ import annotations

from functools import partial

from amalthea_uros.xmi.migrate.steps.kept import restore_2_0_0
from amalthea_uros.xmi.migrate.steps.scheduling import (
    AddedDefinitions,
    convert_algorithms,
    convert_parameters,
    convert_properties,
)
from amalthea_uros.xmi.migrate.steps.tools import add_property, keep_comments, make_positive, move_properties
from amalthea_uros.xmi.migrate.steps.v0_9_7 import conditions_below
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import NoteKind, Postponed, StepNotes

#: References from a measurement to what was measured.
_MEASURED = ("runnable", "task", "eventChain")


def change_0_9_9(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.9.9."""
    for model in models.nodes("measurementModel"):
        _remove_measurements(models, model, notes)
    for event in models.nodes("events"):
        if event.type == "ProcessEvent" and event.get("eventType") == "deadline":
            del event.attributes["eventType"]
            notes.lost(event, "event type 'deadline' no longer exists: the event now means all event types", "", "eventType")


def _remove_measurements(models: ModelSet, model: Node, notes: StepNotes) -> None:
    for measurement in model.all("measurements"):
        measured = next((target for name in _MEASURED for target in measurement.references.get(name, ())), None)
        if measured is not None and not measured.is_proxy:
            _move_properties(measurement, measured, notes)
            keep_comments(measurement, measured)
        name = repr(measured.name) if measured is not None else "unknown"
        what = ("measurement: no longer supported", f"of {name}: {_described(measurement)}")
        if measured is None or measured.is_proxy:
            notes.lost(measurement, *what)
            continue
        # Up to 1.1.0, models of APP4MC are without it.
        keep = partial(add_property, measured, "measured runtimes", _described(measurement))
        models.postponed.append(Postponed("1.2.0", keep, NoteKind.KEPT, measurement, *what))
    if model.parent is not None:
        _move_properties(model, model.parent, notes)
    model.remove()


def _move_properties(source: Node, target: Node, notes: StepNotes) -> None:
    """Keep what the user noted about a measurement with what was measured."""
    for each in move_properties(source, target):
        notes.moved(each, "custom property of a measurement is now one of what was measured", each.get("key"))


def _described(measurement: Node) -> str:
    times = [f"{time.get('value', '0')} {time.get('unit')}".strip() for time in measurement.all("runtimes")]
    deviation = measurement.child("runtimeDeviation")
    if deviation is not None:
        bounds = [f"{part.tag} {part.get('value', '0')} {part.get('unit')}".strip() for part in deviation.children]
        times.append(" ".join([deviation.type, *bounds]))
    properties = [f"custom property {each.get('key')!r}" for each in measurement.all("customProperties")]
    return ", ".join([*times, *properties]) or "no runtimes"


STEP_1_0_0 = Step("0.9.9", "1.0.0", change_0_9_9, frozenset({"measurementModel"}))


def change_1_1_0(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 1.1.0."""
    for stimulus in models.of_type("PeriodicBurstStimulus"):
        make_positive(stimulus, "occurrenceCount", notes)
    for curve in models.of_type("ArrivalCurveStimulus"):
        for entry in curve.all("entries"):
            make_positive(entry, "numberOfOccurrences", notes)


STEP_1_2_0 = Step("1.1.0", "1.2.0", change_1_1_0)


# 1.2.0 -> 2.0.0: scheduling algorithms and their parameters are data, and conditions are more than those about modes


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 1.2.0."""
    definitions = AddedDefinitions(models)
    convert_algorithms(models, definitions, notes)
    convert_parameters(models, definitions, notes)
    convert_properties(models, definitions, notes)
    definitions.insert(notes)
    _convert_conditions(models, notes)
    restore_2_0_0(models, notes)


def _convert_conditions(models: ModelSet, notes: StepNotes) -> None:
    loops = [condition for loop in models.nodes("items") if loop.type == "WhileLoop" for condition in loop.all("condition")]
    # The conditions of mode switches keep their classes until 3.0.0.
    for holder in (*models.nodes("executionCondition"), *loops):
        _rename(holder, "ModeConditionDisjunction", "ConditionDisjunction", notes)
        for condition in conditions_below(holder):
            _rename(condition, "ModeConditionConjunction", "ConditionConjunction", notes)


def _rename(node: Node, old: str, new: str, notes: StepNotes) -> None:
    if node.type == old:
        node.type = new
        notes.renamed(node, f"class is now {new}")


STEP = Step("1.2.0", "2.0.0", change, frozenset({"schedulingAlgorithm", "parameterExtensions"}))
