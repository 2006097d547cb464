"""0.9.2 -> 0.9.3: instructions become ticks, deviations become classes of their own."""

from __future__ import annotations

from typing import NamedTuple

from amalthea_uros.xmi.migrate.steps.tools import by_class, keep_comments, quantity_text
from amalthea_uros.xmi.migrate.steps.v0_9_3_ticks import Ticks
from amalthea_uros.xmi.migrate.steps.v0_9_3_values import CONTINUOUS, TIME, Values
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import NoteKind, StepNotes


class _Place(NamedTuple):
    """Where a class holds a deviation: old and new tag of the part, and the kind of its values."""

    part: str
    becomes: str
    kind: str


_RUNTIME = _Place("runtimeDeviation", "runtimeDeviation", TIME)
_OCCURRENCES = _Place("occurrencesPerStep", "occurrencesPerStep", CONTINUOUS)

_DEVIATIONS = {
    "PeriodicStimulus": _Place("jitter", "jitter", TIME),
    "RelativePeriodicStimulus": _Place("nextOccurrence", "nextOccurrence", TIME),
    "SporadicActivation": _Place("activationDeviation", "occurrence", TIME),
    "VariableRateStimulus": _OCCURRENCES,
    "VariableRateActivation": _OCCURRENCES,
    "EventChainMeasurement": _RUNTIME,
    "RunnableMeasurement": _RUNTIME,
    "TaskMeasurement": _RUNTIME,
}

_LATENCIES = ("LatencyConstant", "LatencyDeviation")

_STEP_LIMITS = ("maxIncreasePerStep", "maxDecreasePerStep")


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.9.2."""
    found = by_class(models, (*_DEVIATIONS, *_LATENCIES, "ExecutionNeed", "PeriodicActivation"))
    values = Values(notes)
    ticks = Ticks(models, values, notes)
    ticks.convert_needs(found["ExecutionNeed"])
    ticks.convert_overheads(models.nodes("osOverheads"))
    models.rename_classes({"OsInstructions": "OsOverhead"})
    # Their ticks are the same on all cores, so that there is no place for a quotient.
    kind = NoteKind.TO_CHECK if ticks.rates else NoteKind.RENAMED
    for node in models.nodes("transmissionPolicy"):
        if node.rename("chunkProcessingInstructions", "chunkProcessingTicks"):
            message = "instructions per chunk are now ticks, not divided by the instructions per cycle"
            notes.add(kind, node, message, node.get("chunkProcessingTicks"), "chunkProcessingInstructions")
    for name in _LATENCIES:
        for node in found[name]:
            _convert_latency(node, values, notes)
    for name, place in _DEVIATIONS.items():
        for node in found[name]:
            _convert_deviations(node, place, values, notes)
    for node in found["VariableRateStimulus"]:
        _convert_step_limits(node, notes)
    for node in found["PeriodicActivation"]:
        _state_recurrence(node, notes)


def _state_recurrence(activation: Node, notes: StepNotes) -> None:
    """State the recurrence, which is required now, where it follows: the least distance is the greatest one, too."""
    least, most = activation.child("min"), activation.child("max")
    if activation.child("recurrence") is not None or least is None or most is None or least.attributes != most.attributes:
        return
    recurrence = least.copy()
    recurrence.tag = "recurrence"
    activation.insert(recurrence, activation.children.index(most) + 1)
    notes.converted(activation, "recurrence of a periodic activation: its equal minimum and maximum", quantity_text(least))


def _convert_latency(node: Node, values: Values, notes: StepNotes) -> None:
    if node.parent is None:
        # Only in damaged files.
        return
    stated = values.number(node, node.tag, node.parent)
    if stated is None:
        node.remove()
        return
    node.replace_by(stated)
    keep_comments(node, stated)
    notes.converted(node, "latency now has one class per distribution", stated.type)


def _convert_deviations(node: Node, place: _Place, values: Values, notes: StepNotes) -> None:
    for part in node.all(place.part):
        if part.type:
            # Already in the newer form, where a class is always stated.
            part.tag = place.becomes
            continue
        if not values.restate(part, place.kind, place.becomes, node):
            part.remove()
            continue
        notes.converted(part, "deviation now has one class per distribution", part.type)


def _convert_step_limits(node: Node, notes: StepNotes) -> None:
    for part in node.all(*_STEP_LIMITS):
        if "value" in part.attributes:
            node.attributes[part.tag] = part.attributes["value"]
            notes.converted(part, "the limit of a step is now an attribute", part.attributes["value"])
        else:
            notes.lost(part, "a limit of a step without a value")
        part.remove()


STEP = Step(
    "0.9.2",
    "0.9.3",
    change,
    frozenset(
        {
            *("NeedConstant", "NeedDeviation", "InstructionsConstant", "InstructionsDeviation"),
            *("LatencyConstant", "LatencyDeviation", "activationDeviation"),
            *("BetaDistribution", "Boundaries", "GaussDistribution", "UniformDistribution", "WeibullEstimators"),
            "WeibullParameters",
        }
    ),
)
