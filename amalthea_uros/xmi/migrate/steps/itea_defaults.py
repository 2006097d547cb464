"""Values that ITEA 1.2.0 assumed where a file stated none, and that ITEA 1.3.0 does not assume: they are written.

All enumerations got `_undefined_` as their first literal, which thereby became the default.
"""

from __future__ import annotations

from functools import partial

from amalthea_uros.xmi.migrate.classes import local_name
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Kind, Notes
from amalthea_uros.xmi.migrate.postponed import Postponed
from amalthea_uros.xmi.migrate.steps.later import BEYOND_ITEA, lose_for_now

_EQUAL = (
    ("HwCoreProperty", "comparator", "equal"),
    ("HwMemoryProperty", "comparator", "equal"),
    ("HwCoreConjunction", "conjunction", "and"),
    ("HwMemoryConjunction", "conjunction", "and"),
)
_ITEMS = (("LabelAccess", "access", "read"), ("SemaphoreAccess", "accessEnum", "request"))
_COMPLEX_PIN = (("ComplexPin", "direction", "R"), ("ComplexPin", "type", "ANALOG"))
_FEATURE = (("FeatureTypes", "value", "floatingPointUnit"),)

#: Defaults by the tag: class ("" for any), attribute, value. Tags that are classes are roots of files that hold one such object.
_DEFAULTS: dict[str, tuple[tuple[str, str, str], ...]] = {
    "accessPrecedenceSpec": (("", "orderType", "ignoreWR"),),
    "attribute": _FEATURE,
    "calls": (("WaitEvent", "maskType", "AND"),),
    "features": _FEATURE,
    "firstConstraint": _EQUAL,
    "hwConstraint": _EQUAL,
    "mappingModel": (("", "addressMappingType", "none"),),
    "memTypeDefinitions": (("", "type", "RAM"),),
    "memoryTypes": (("", "type", "RAM"),),
    "networkTypes": (("Bus", "busType", "CAN"), ("", "schedPolicy", "RROBIN")),
    "orderPrecedenceSpec": (("", "orderType", "order"),),
    "pins": _COMPLEX_PIN,
    "ports": (("ComplexPort", "direction", "R"), ("FInterfacePort", "kind", "PROVIDES")),
    "processPrototypes": (("", "preemption", "cooperative"),),
    "quartzes": (("", "type", "DYNAMIC"),),
    "runnableGroups": (("", "groupingType", "allOfThem"),),
    "runnableItem": _ITEMS,
    "runnableItems": _ITEMS,
    "runnableSequencingConstraints": (("", "orderType", "successor"),),
    "secondConstraint": _EQUAL,
    "Bus": (("", "busType", "CAN"),),
    "ComplexPin": (("", "direction", "R"), ("", "type", "ANALOG")),
    "ComplexPort": (("", "direction", "R"),),
    "FeatureTypes": (("", "value", "floatingPointUnit"),),
    "MappingModel": (("", "addressMappingType", "none"),),
    "MemType": (("", "type", "RAM"),),
    "NetworkType": (("", "schedPolicy", "RROBIN"),),
    "Quartz": (("", "type", "DYNAMIC"),),
}

_CYCLE = ("ClockTriangleFunction", "ClockSinusFunction")
_ACTIVATION: dict[str, tuple[str, ...]] = {"activations": ("Periodic", "SingleActivation")}
_ENTRY: dict[str, tuple[str, ...]] = {"arrivalCurveEntries": ("",)}

#: Tags of times -> tags of their containers -> classes of these, "" for any.
_TIMES: dict[str, dict[str, tuple[str, ...]]] = {
    "activation": {"stimuli": ("Single",)},
    "deadline": {"activations": ("Periodic",), "runnables": ("",), "runnable": ("",), "Runnable": ("",)},
    "delay": {"schedulingUnit": ("SchedulingHWUnit",)},
    "jitter": {"timingConstraints": ("RepetitionConstraint",)},
    "lower": {"timingConstraints": ("DelayConstraint", "RepetitionConstraint")},
    "lowerTimeBorder": _ENTRY,
    "max": _ACTIVATION,
    "maximum": {"timingConstraints": ("AgeConstraint", "ReactionConstraint")},
    "maximumTime": {"dataAge": ("DataAgeTime",)},
    "min": _ACTIVATION,
    "minimum": {"timingConstraints": ("AgeConstraint", "ReactionConstraint")},
    "minimumTime": {"dataAge": ("DataAgeTime",)},
    "offset": {"stimuli": ("Periodic",), "activations": ("Periodic",)},
    "period": {"clocks": _CYCLE},
    "recurrence": {"stimuli": ("Periodic",)},
    "shift": {"clocks": _CYCLE},
    "time": {"entries": ("",)},
    "tolerance": {"timingConstraints": ("SynchronisationConstraint",)},
    "upper": {"timingConstraints": ("DelayConstraint", "RepetitionConstraint")},
    "upperTimeBorder": _ENTRY,
}

#: More of them, which the official converter is not known to write.
_MORE_DEFAULTS = {"latencies": (("", "accessType", "R"),)}

#: Times that the official converter leaves without unit.
_MORE_TIMES: dict[str, dict[str, tuple[str, ...]]] = {"limitValue": {"limit": ("TimeRequirementLimit",)}}

_COOPERATIVE = "preemption of a task: 'cooperative' was the default, and the file does not state it"

_TIME_CLASSES = ("SignedTime", "Time", "SignedTimeObject", "TimeObject")


def write_defaults(models: ModelSet, notes: Notes, official: bool) -> None:
    """Write what the files do not state, but what they mean."""
    for tag, rules in (_DEFAULTS if official else _DEFAULTS | _MORE_DEFAULTS).items():
        for node in models.nodes(tag):
            if official and _is_overlooked(node):
                continue
            for class_name, attribute, value in rules:
                if not class_name or local_name(node.type) == class_name:
                    _write(node, attribute, value, notes)
    _write_preemption(models, notes, official)
    for tag, containers in (_TIMES if official else _TIMES | _MORE_TIMES).items():
        for node in models.nodes(tag):
            if _is_in(node, containers):
                _write(node, "unit", "ps", notes)
    for node in _times_by_class(models, official):
        if local_name(node.type) in _TIME_CLASSES:
            _write(node, "unit", "ps", notes)


def _is_overlooked(node: Node) -> bool:
    """Whether the official converter does not look there."""
    if node.tag == "attribute":
        return True
    holder = node.parent
    if node.tag == "runnableGroups" and holder is not None:
        holder = holder.parent
    return node.tag in ("runnableGroups", "runnableSequencingConstraints") and (
        holder is None or holder.tag != "constraintsModel"
    )


def _write_preemption(models: ModelSet, notes: Notes, official: bool) -> None:
    for task in models.nodes("tasks"):
        if task.parent is not None and task.parent.tag == "swModel":
            _write(task, "preemption", "cooperative", notes)
        elif "preemption" not in task.attributes:
            # The published conversions leave it unstated in files that hold nothing but the software model.
            write = partial(task.attributes.setdefault, "preemption", "cooperative")
            lose_for_now(models, notes, official, Postponed(BEYOND_ITEA, write, Kind.DEFAULTED, task, _COOPERATIVE, task.name))


def _is_in(node: Node, containers: dict[str, tuple[str, ...]]) -> bool:
    holder = node.parent
    if holder is None:
        return False
    classes = containers.get(holder.tag, ())
    return "" in classes or local_name(holder.type) in classes


def _times_by_class(models: ModelSet, official: bool) -> list[Node]:
    """What is a time only if its `xsi:type` says so: the values of deviations, and of custom properties."""
    deviations = models.nodes("stimulusDeviation")
    found = [part for deviation in deviations for part in deviation.all("lowerBound", "upperBound")]
    found += [part for deviation in deviations for part in deviation.find("distribution") for part in part.children]
    if not official:
        found += models.nodes("value", "values")
    return found


def _write(node: Node, attribute: str, value: str, notes: Notes) -> None:
    if attribute not in node.attributes and attribute not in node.references:
        node.attributes[attribute] = value
        notes.defaulted(node, f"{attribute}={value!r} is written: it was the default", attribute=attribute)
