"""ITEA 1.2.0 -> ITEA 1.3.0: written defaults, deadlines as requirements, modes, parts of component models."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from amalthea_uros.xmi.migrate.steps.file_roots import SUB_MODELS, by_root, sub_model_or_new, trees_of, wrap_objects
from amalthea_uros.xmi.migrate.steps.tools import add_property
from amalthea_uros.xmi.tree.classes import local_name
from amalthea_uros.xmi.tree.model_set import ModelSet, Step, Tree
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import BEYOND_ITEA, NoteKind, Postponed, StepNotes

# Defaults: all enumerations got `_undefined_` as their first literal, which thereby became the default

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


def write_defaults(models: ModelSet, notes: StepNotes) -> None:
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


def _write_preemption(models: ModelSet, notes: StepNotes) -> None:
    for task in models.nodes("tasks"):
        if task.parent is not None and task.parent.tag == "swModel":
            _write(task, "preemption", "cooperative", notes)
        elif "preemption" not in task.attributes:
            # The published conversions leave it unstated in files that hold nothing but the software model.
            write = partial(task.attributes.setdefault, "preemption", "cooperative")
            models.postponed.append(Postponed(BEYOND_ITEA, write, NoteKind.DEFAULTED, task, _COOPERATIVE, task.name))


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


def _write(node: Node, attribute: str, value: str, notes: StepNotes) -> None:
    if attribute not in node.attributes and attribute not in node.references:
        node.attributes[attribute] = value
        notes.defaulted(node, f"{attribute}={value!r} is written: it was the default", attribute=attribute)


# Modes: values of labels that select what is executed, in label switches and conditions of stimuli

_LISTS = {
    "setLabelsList": "setModeValueList",
    "enablingLabelsList": "enablingModeValueList",
    "disablingLabelsList": "disablingModeValueList",
}


def convert_label_values(models: ModelSet, notes: StepNotes) -> None:
    """Make labels that select something mode labels, and their values literals of modes."""
    converter = _LabelConverter(models, notes)
    converter.convert_stimuli()
    converter.convert_switches()


class _LabelConverter:
    def __init__(self, models: ModelSet, notes: StepNotes) -> None:
        self.models, self.notes = models, notes
        #: The mode labels that take the place of labels.
        self.made: dict[Node, Node] = {}
        #: Mode labels by name and the root of their file.
        self.known: dict[tuple[Node, str], Node] = {}
        for node in models.nodes("modeLabels"):
            self.known.setdefault((node.root, node.name), node)

    def convert_stimuli(self) -> None:
        """Convert the lists of values that stimuli set, and which enable and disable them."""
        lists = [part for stimulus in self.models.nodes("stimuli") for part in stimulus.all(*_LISTS)]
        for part in lists:
            self.notes.renamed(part, f"{part.tag} is {_LISTS[part.tag]}")
            part.tag = _LISTS[part.tag]
        entries = [entry for part in lists for entry in part.all("entries")]
        self.make_modes(entries, "valueProvider", "mode_stimuli_{}_migration_generated", 1)
        for entry in entries:
            self.provide(entry, "valueProvider")

    def convert_switches(self) -> None:
        """Make label switches mode switches."""
        switches = []
        for switch in self.models.nodes("graphEntries"):
            if local_name(switch.type) != "LabelSwitch":
                continue
            label = switch.target("label")
            self.provide(switch, "label")
            switch.rename("label", "valueProvider")
            switch.type = "sw:ModeSwitch"
            switches.append(switch)
            self.notes.converted(
                switch, "label switch: mode switch on a mode label of the same name", label.name if label else ""
            )
        converted = set(switches)
        entries = [entry for entry in self.models.nodes("entries") if entry.parent in converted]
        self.make_modes(entries, "valueProvider", "mode_sw_{}_migration_generated", 0)

    # Labels

    def provide(self, holder: Node, reference: str) -> None:
        """Let a reference to a label name its mode label."""
        labels = holder.references.get(reference)
        if labels:
            source = holder.root
            holder.references[reference] = [self.mode_label(label, source) for label in labels]

    def mode_label(self, label: Node, source: Node) -> Node:
        """The mode label of the name of a label; the label stays, because others may access it."""
        holder = label.parent
        if label.tag != "labels" or holder is None:
            if label.is_proxy:
                self.notes.lost(source, "mode label of a label that is not in the files", label.get("path"))
            return label
        found = self.made.get(label) or (self.known.get((label.root, label.name)) if label.name else None)
        if found is None:
            found = holder.add("modeLabels", like=label)
            found.attributes |= {"name": label.name} if "name" in label.attributes else {}
            found.target_class = "sw:ModeLabel"
            self.notes.converted(label, "label that selects something: a mode label of the same name is added", label.name)
        self.made[label] = found
        return found

    # Values

    def make_modes(self, entries: Iterable[Node], reference: str, name: str, first: int) -> None:
        """One mode for each file: its literals are the different values that its entries state.

        Parameters
        ----------
        reference : that of entries to labels
        name : that of the modes, with a place for the number
        first : number of the first mode
        """
        number = first
        trees = trees_of(self.models)
        converted = [entry for entry in entries if "value" not in entry.references]
        for root, own in by_root(converted).items():
            model = self.model_for(trees[root], own, reference)
            if model is None:
                continue
            mode = model.add("modes", like=own[0], name=name.format(number))
            mode.target_class = "common:Mode"
            number += 1
            self.notes.converted(mode, "values of labels: literals of a new mode", mode.name)
            self.give_literals(mode, own)

    def give_literals(self, mode: Node, entries: Sequence[Node]) -> None:
        """Make the values of entries references to literals of a mode."""
        literals: dict[str, Node] = {}
        for entry in entries:
            # The default of the attribute was 0.
            value = entry.attributes.pop("value", "0")
            literal = literals.get(value)
            if literal is None:
                literal = literals[value] = mode.add("literals", like=entry, name=value)
                literal.target_class = "common:ModeLiteral"
            entry.refer("value", literal)

    def model_for(self, tree: Tree, entries: Sequence[Node], reference: str) -> Node | None:
        """The software model that the mode of a file belongs to: its own; a new one, or that of the labels if the file has no place."""
        own = tree.root if tree.root.tag == "SWModel" else tree.root.child("swModel")
        if own is not None:
            return own
        for entry in entries if tree.root.tag in SUB_MODELS else ():
            label = entry.target(reference)
            if (
                label is not None
                and label.parent is not None
                and "swModel" in (label.parent.tag, SUB_MODELS.get(label.parent.tag))
            ):
                return label.parent
        return sub_model_or_new(tree, "swModel")


#: Parts of component models, by class -> tag, and whether the class is still stated.
_COMPONENT_PARTS = {
    "Component": ("components", False),
    "Composite": ("components", True),
    "System": ("systems", False),
    "ComponentInstance": ("componentInstances", False),
    "Connector": ("connectors", False),
}

_PROCESSES = ("isrs", "tasks", "processPrototypes")


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA ITEA 1.2.0."""
    wrap_objects(models, notes)
    write_defaults(models, notes)
    for node in models.rename_classes({"sw:SchedulingSWUnit": "os:SchedulingSWUnit"}):
        notes.renamed(node, "class SchedulingSWUnit moves from package sw to os")
    _rename_attributes(models, notes)
    _remove_unspecified(models, notes)
    _split_components(models, notes)
    convert_label_values(models, notes)
    _convert_deadlines(models, notes)
    for label in models.nodes("labels"):
        value = label.attributes.pop("initialValue", None)
        if value is not None:
            keep = partial(add_property, label, "initialValue", value)
            what = ("initial value of a label", f"{label.name}: {value}", "initialValue")
            models.postponed.append(Postponed(BEYOND_ITEA, keep, NoteKind.KEPT, label, *what))


def _rename_attributes(models: ModelSet, notes: StepNotes) -> None:
    for tag in models.nodes("tags"):
        if tag.rename("tagName", "name"):
            notes.renamed(tag, "tagName is name", attribute="tagName")
    for age in models.nodes("dataAge"):
        if age.rename("maximumCyle", "maximumCycle"):
            notes.renamed(age, "maximumCyle is maximumCycle", attribute="maximumCyle")


def _remove_unspecified(models: ModelSet, notes: StepNotes) -> None:
    for node in models.nodes("calls", "runnableItems", "runnableItem"):
        if node.attributes.get("waitingBehaviour") == "unspecified":
            del node.attributes["waitingBehaviour"]
            notes.renamed(
                node, "waitingBehaviour='unspecified' is not written: it is the default", attribute="waitingBehaviour"
            )


def _split_components(models: ModelSet, notes: StepNotes) -> None:
    for node in models.nodes("elements"):
        known = _COMPONENT_PARTS.get(local_name(node.type))
        if known is None:
            continue
        node.tag, is_stated = known
        if not is_stated:
            node.target_class, node.type = node.type, ""
        notes.renamed(node, f"elements of component models: {node.tag}", node.name)


def _convert_deadlines(models: ModelSet, notes: StepNotes) -> None:
    """Deadlines of tasks, ISRs and prototypes -> requirements."""
    trees = trees_of(models)
    holders = [node for node in models.nodes(*_PROCESSES) if node.children and node.child("deadline") is not None]
    holders.sort(key=lambda node: node.origin)
    for root, processes in by_root(holders).items():
        for process in processes:
            deadlines = process.all("deadline")
            for deadline in deadlines:
                requirement = _require(sub_model_or_new(trees[root], "constraintsModel"), process, deadline, notes)
                if "value" not in deadline.attributes:
                    message = "a deadline without value is no requirement"
                    drop = requirement.remove
                    models.postponed.append(Postponed(BEYOND_ITEA, drop, NoteKind.CONVERTED, deadline, message, is_kept=True))
            remove_all(deadlines)


def _require(model: Node, process: Node, deadline: Node, notes: StepNotes) -> Node:
    requirement = model.add("requirements", "constraints:ProcessRequirement", like=deadline)
    requirement.attributes |= {"name": process.name} if "name" in process.attributes else {}
    requirement.attributes["severity"] = "Cosmetic"
    requirement.refer("process", process)
    requirement.comments = deadline.comments
    limit = requirement.add("limit", "constraints:TimeRequirementLimit", limitType="UpperLimit", metric="ResponseTime")
    # A time without value was 0.
    value, unit = deadline.get("value", "0"), deadline.get("unit", "ps")
    limit.add("limitValue", value=value, unit=unit)
    notes.converted(deadline, "deadline: requirement for the response time", f"{process.name}: {value} {unit}")
    return requirement


STEP = Step(
    "ITEA 1.2.0",
    "ITEA 1.3.0",
    change,
    frozenset({"setLabelsList", "enablingLabelsList", "disablingLabelsList", "sw:LabelSwitch", "sw:SchedulingSWUnit"}),
)
