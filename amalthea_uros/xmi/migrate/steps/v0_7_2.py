"""0.7.1 -> 0.7.2: data stability, instructions, groups, tags, and hardware inside of property constraints."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.file_roots import wrap_roots
from amalthea_uros.xmi.migrate.steps.v0_7_1_sections import name_mappings
from amalthea_uros.xmi.migrate.steps.v0_7_2_hardware import move_hardware
from amalthea_uros.xmi.migrate.steps.v0_7_2_runnables import change_runnable_items
from amalthea_uros.xmi.migrate.steps.v0_7_tools import content_of, relink

#: Files that came from ITEA versions have the boolean of those.
_STABILITY = {
    "buffered": "customProtection",
    "notBuffered": "noProtection",
    "true": "customProtection",
    "false": "noProtection",
}

_RENAMED_CLASSES = {
    "OsExecutionInstructions": "Instructions",
    "OsExecutionInstructionsConstant": "InstructionsConstant",
    "OsExecutionInstructionsDeviation": "InstructionsDeviation",
}

_MODELS_WITH_TAGS = ("componentsModel", "hwModel", "swModel")

_REMOVED_TARGETS = frozenset({"TargetProcess", "TargetCallSequence"})

#: Class of a constraint -> the old tag of its group.
_GROUPS = {"DataPairingConstraint": "labels", "ProcessPairingConstraint": "processes", "RunnablePairingConstraint": "runnables"}

#: Attribute of OsBuffering -> level of DataStability. Only one is possible: the first.
_LEVELS = {"processLevel": "process", "runnableLevel": "runnable", "scheduleSectionLevel": "scheduleSection"}


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 0.7.1."""
    wrap_roots(models, notes)
    _change_attributes(models, notes)
    change_runnable_items(models, notes)
    for found in models.rename_classes(_RENAMED_CLASSES):
        notes.renamed(found, f"instructions of the operating system -> {found.type}")
    for curve in models.nodes("arrivalCurveEntries"):
        curve.tag = "entries"
        notes.renamed(curve, "arrivalCurveEntries -> entries")
    _change_constraints(models, notes)
    for os_model in models.parts("osModel"):
        _change_buffering(os_model, notes)
    _move_tags(models, notes)
    name_mappings(models, notes)
    move_hardware(models, notes)
    _change_traced_events(models, notes)


def _change_attributes(models: ModelSet, notes: Notes) -> None:
    """Attributes that several classes have."""
    for node in models.walk():
        attributes = node.attributes
        if "buffered" in attributes and not node.type.startswith("SenderReceiver"):
            old = attributes.pop("buffered")
            attributes["dataStability"] = _STABILITY.get(old, old)
            notes.converted(node, "buffered -> dataStability", f"{old} -> {attributes['dataStability']}", "buffered")
        if "initalValue" in attributes:
            attributes["initialValue"] = attributes.pop("initalValue")
            notes.renamed(node, "initalValue -> initialValue", attribute="initalValue")
        if attributes.get("preemption") == "unknown":
            del attributes["preemption"]
            notes.converted(node, "preemption 'unknown' -> not stated", attribute="preemption")
        if "samplingType" in attributes and node.tag != "distribution":
            _move_sampling(node, attributes.pop("samplingType"), notes)


def _move_sampling(deviation: Node, sampling: str, notes: Notes) -> None:
    """Only the distribution Boundaries has a sampling type now."""
    distribution = deviation.child("distribution")
    # Without a distribution, the bounds are all that there is to sample.
    if distribution is None:
        distribution = deviation.add("distribution", "Boundaries")
    if distribution.type == "Boundaries":
        distribution.attributes["samplingType"] = sampling
        notes.moved(deviation, "samplingType of a deviation -> samplingType of its Boundaries", sampling, "samplingType")
    else:
        notes.lost(deviation, "samplingType of a deviation: only the distribution Boundaries has one", sampling, "samplingType")


def _change_constraints(models: ModelSet, notes: Notes) -> None:
    removed = [node for node in models.nodes("target") if node.type in _REMOVED_TARGETS]
    for target in removed:
        notes.lost(target, f"{target.type}: targets of runnable constraints are schedulers or cores", content_of(target))
    remove_all(removed)
    for constraint in models.nodes("affinityConstraints"):
        groups = constraint.all(_GROUPS[constraint.type]) if constraint.type in _GROUPS else []
        for group in groups:
            notes.renamed(constraint, f"{group.tag} of a {constraint.type} -> group")
            group.tag = "group"


def _change_buffering(os_model: Node, notes: Notes) -> None:
    buffering, consistency = os_model.child("osBuffering"), os_model.child("osDataConsistency")
    if buffering is None:
        if consistency is None and not os_model.find("operatingSystems", "osDataConsistency"):
            os_model.add("osDataConsistency")
        return
    if consistency is not None:
        notes.lost(buffering, "osBuffering: there is osDataConsistency, too", content_of(buffering))
        buffering.remove()
        return
    stated = buffering.attributes
    levels = [level for name, level in _LEVELS.items() if stated.get(name) == "true"]
    algorithm = stated.get("bufferingAlgorithm")
    buffering.tag, buffering.attributes = "osDataConsistency", {"mode": "automaticProtection" if levels else "noProtection"}
    notes.converted(buffering, "osBuffering -> osDataConsistency", ", ".join(levels) or "no level")
    if levels:
        stability = buffering.add("dataStability", enabled="true", accessMultiplicity="multipleAccesses", level=levels[0])
        if algorithm is not None:
            stability.attributes["algorithm"] = algorithm
    elif algorithm:
        notes.lost(buffering, "algorithm of osBuffering, which has no level", algorithm, "bufferingAlgorithm")
    if levels[1:]:
        notes.lost(buffering, "level of osBuffering: data stability has only one", ", ".join(levels[1:]))


def _move_tags(models: ModelSet, notes: Notes) -> None:
    """Tags of all models are common elements; those of the same name in a file become one."""
    replaced: dict[Node, Node] = {}
    for root in models.roots:
        moved = [tag for model in root.all(*_MODELS_WITH_TAGS) for tag in model.all("tags")]
        if not moved:
            continue
        common = root.child_or_new("commonElements")
        known = [*common.all("tags"), *moved]
        first = {tag.name: tag for tag in reversed(known) if tag.name}
        for tag in moved:
            same = first.get(tag.name, tag)
            if same is tag:
                notes.moved(tag, "tags -> commonElements")
                continue
            replaced[tag] = same
            if tag.attributes == same.attributes and not tag.children:
                notes.moved(tag, "tags -> commonElements, one of those of the same name")
            else:
                notes.lost(tag, "a tag differs from another one of the same name, which is kept", content_of(tag))
        common.take(tag for tag in moved if tag not in replaced)
    remove_all(replaced)
    relink(models, replaced)


def _change_traced_events(models: ModelSet, notes: Notes) -> None:
    """Configurations of traces refer to events; those that contain one move it to the event model."""
    moved: dict[Node, list[Node]] = {}
    for config in models.nodes("eventsToTrace"):
        if config.type not in ("EventConfigElement", "EventConfigLink"):
            continue
        events = config.all("event")
        for event in events:
            event.tag = "events"
            notes.moved(event, "event of a trace configuration -> eventModel", event.name)
        moved.setdefault(config.root, []).extend(events)
        notes.renamed(config, f"{config.type} -> EventConfig")
        config.type = ""
        if events:
            config.refer("event", *events)
    for root, events in moved.items():
        if events:
            root.child_or_new("eventModel").take(events)


STEP = Step(
    "0.7.1",
    "0.7.2",
    change,
    frozenset(
        {
            *("arrivalCurveEntries", "coreTypeDefinitions", "memoryTypeDefinitions", "osBuffering", "runnableItem"),
            *("EventConfigElement", "EventConfigLink", "ProbabilityGroup"),
            *_REMOVED_TARGETS,
            *_RENAMED_CLASSES,
        }
    ),
)
