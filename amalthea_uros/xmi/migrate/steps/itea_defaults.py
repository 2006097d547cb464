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
from amalthea_uros.xmi.migrate.steps.later import BEYOND_ITEA

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
    "latencies": (("", "accessType", "R"),),
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
    "limitValue": {"limit": ("TimeRequirementLimit",)},
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

_COOPERATIVE = "preemption of a task: 'cooperative' was the default, and the file does not state it"

_TIME_CLASSES = ("SignedTime", "Time", "SignedTimeObject", "TimeObject")


def write_defaults(models: ModelSet, notes: Notes) -> None:
    """Write what the files do not state, but what they mean."""
    for tag, rules in _DEFAULTS.items():
        for node in models.nodes(tag):
            for class_name, attribute, value in rules:
                if not class_name or local_name(node.type) == class_name:
                    _write(node, attribute, value, notes)
    _write_preemption(models, notes)
    for tag, containers in _TIMES.items():
        for node in models.nodes(tag):
            if _is_in(node, containers):
                _write(node, "unit", "ps", notes)
    for node in _times_by_class(models):
        if local_name(node.type) in _TIME_CLASSES:
            _write(node, "unit", "ps", notes)


def _write_preemption(models: ModelSet, notes: Notes) -> None:
    for task in models.nodes("tasks"):
        if task.parent is not None and task.parent.tag == "swModel":
            _write(task, "preemption", "cooperative", notes)
        elif "preemption" not in task.attributes:
            # The published conversions leave it unstated in files that hold nothing but the software model.
            write = partial(task.attributes.setdefault, "preemption", "cooperative")
            models.postponed.append(Postponed(BEYOND_ITEA, write, Kind.DEFAULTED, task, _COOPERATIVE, task.name))


def _is_in(node: Node, containers: dict[str, tuple[str, ...]]) -> bool:
    holder = node.parent
    if holder is None:
        return False
    classes = containers.get(holder.tag, ())
    return "" in classes or local_name(holder.type) in classes


def _times_by_class(models: ModelSet) -> list[Node]:
    """What is a time only if its `xsi:type` says so: the values of deviations, and of custom properties."""
    deviations = models.nodes("stimulusDeviation")
    found = [part for deviation in deviations for part in deviation.all("lowerBound", "upperBound")]
    found += [part for deviation in deviations for part in deviation.find("distribution") for part in part.children]
    found += models.nodes("value", "values")
    return found


def _write(node: Node, attribute: str, value: str, notes: Notes) -> None:
    if attribute not in node.attributes and attribute not in node.references:
        node.attributes[attribute] = value
        notes.defaulted(node, f"{attribute}={value!r} is written: it was the default", attribute=attribute)
