"""Roots of files that are sub-models, or parts of them: up to 0.7.0, and in one published file of 0.7.2, any object could be one."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.xmi.tree.classes import local_name
from amalthea_uros.xmi.tree.model_set import ModelSet, Tree
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

#: Sub-models by the class that is the root of a file which holds nothing else.
SUB_MODELS = {
    "CommonElements": "commonElements",
    "ComponentsModel": "componentsModel",
    "ConfigModel": "configModel",
    "ConstraintsModel": "constraintsModel",
    "EventModel": "eventModel",
    "HWModel": "hwModel",
    "MappingModel": "mappingModel",
    "OSModel": "osModel",
    "PropertyConstraintsModel": "propertyConstraintsModel",
    "StimuliModel": "stimuliModel",
    "SWModel": "swModel",
}


def sub_models(models: ModelSet, tag: str) -> list[Node]:
    """The sub-models of a tag, whether they are parts of a model or roots of files."""
    classes = [root_class for root_class, known in SUB_MODELS.items() if known == tag]
    return [node for root in models.roots for node in ([root] if root.tag in classes else root.all(tag))]


def sub_model_or_new(tree: Tree, tag: str) -> Node:
    """The sub-model of that tag in a file, made if there is none; a file of another sub-model becomes a whole model for it."""
    root = tree.root
    if SUB_MODELS.get(root.tag) == tag:
        return root
    if root.tag in SUB_MODELS:
        tree.root = Node("AMALTHEA", origin=root.origin)
        tree.root.comments, root.comments = root.comments, None
        root.tag = SUB_MODELS[root.tag]
        tree.root.insert(root)
    return tree.root.child_or_new(tag)


def is_isr(process: Node) -> bool:
    """Whether a process is an ISR, as far as that is known of one that is in no file."""
    return process.tag == "isrs" or local_name(process.type or process.get("class")) == "ISR"


def trees_of(models: ModelSet) -> dict[Node, Tree]:
    """The files that the present step is about, by their roots."""
    return {tree.root: tree for tree in models.active}


def by_root(nodes: Iterable[Node]) -> dict[Node, list[Node]]:
    """Nodes by the roots of their files, in order."""
    found: dict[Node, list[Node]] = {}
    for node in nodes:
        found.setdefault(node.root, []).append(node)
    return found


# Where the root of a file belongs in a whole model

_MICROCONTROLLER = ("hwModel", "system", "ecus", "microcontrollers")
_OPERATING_SYSTEM = ("osModel", "operatingSystems")

#: Class of a root -> the tags from the root of a model on that lead to such an object. The last one does not need the class as type.
_PLACES: dict[str, tuple[str, ...]] = {
    **{name: (tag,) for name, tag in SUB_MODELS.items()},
    "Component": ("componentsModel", "components"),
    "Core": (*_MICROCONTROLLER, "cores"),
    "CoreType": ("hwModel", "coreTypes"),
    "ECU": ("hwModel", "system", "ecus"),
    "ECUType": ("hwModel", "ecuTypes"),
    "EventChain": ("constraintsModel", "eventChains"),
    "HwSystem": ("hwModel", "system"),
    "ISR": ("swModel", "isrs"),
    "InterruptController": (*_OPERATING_SYSTEM, "interruptControllers"),
    "Label": ("swModel", "labels"),
    "Memory": (*_MICROCONTROLLER, "memories"),
    "MemType": ("hwModel", "memoryTypes"),
    "MemoryType": ("hwModel", "memoryTypes"),
    "Microcontroller": _MICROCONTROLLER,
    "MicrocontrollerType": ("hwModel", "mcTypes"),
    "Mode": ("swModel", "modes"),
    "ModeLabel": ("swModel", "modeLabels"),
    "Network": (*_MICROCONTROLLER, "networks"),
    "OperatingSystem": _OPERATING_SYSTEM,
    "ProcessPrototype": ("swModel", "processPrototypes"),
    "Quartz": ("hwModel", "system", "quartzes"),
    "Runnable": ("swModel", "runnables"),
    "Section": ("swModel", "sections"),
    "Semaphore": ("osModel", "semaphores"),
    "SystemType": ("hwModel", "systemTypes"),
    "Tag": ("swModel", "tags"),
    "Task": ("swModel", "tasks"),
    "TaskScheduler": (*_OPERATING_SYSTEM, "taskSchedulers"),
}

_STIMULI = (
    "ArrivalCurve",
    "CustomStimulus",
    "EventStimulus",
    "InterProcess",
    "Periodic",
    "PeriodicEvent",
    "Single",
    "Sporadic",
)
_EVENTS = (
    "ChannelEvent",
    "LabelEvent",
    "ModeLabelEvent",
    "ProcessChainEvent",
    "ProcessEvent",
    "RunnableEvent",
    "SemaphoreEvent",
    "StimulusEvent",
)

#: The same for objects that state their class by `xsi:type`.
_TYPED_PLACES: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("Bridge", "Bus", "CrossbarSwitch", "NetworkType"), ("hwModel", "networkTypes")),
    **dict.fromkeys((*_STIMULI, "Synthetic"), ("stimuliModel", "stimuli")),
    **dict.fromkeys(("ClockMultiplierList", "ClockSinusFunction", "ClockTriangleFunction"), ("stimuliModel", "clocks")),
    **dict.fromkeys(_EVENTS, ("eventModel", "events")),
    "VendorOperatingSystem": _OPERATING_SYSTEM,
}

#: Parts of hardware that mean nothing without the object that they belong to.
_PLACELESS = frozenset({"ComplexPin", "ComplexPort", "HwPort", "Pin", "Prescaler"})


def wrap_roots(models: ModelSet, notes: StepNotes) -> None:
    """Put the roots of files that are not whole models into models."""
    for tree in models.active:
        root = tree.root
        place = _place_of(root)
        if place:
            _wrap(tree, place, "Amalthea", notes)
        elif root.tag in _PLACELESS:
            notes.lost(root, "root of a file that is part of an object in no file", root.tag)
            tree.root = Node("Amalthea", origin=root.origin)


def wrap_objects(models: ModelSet, notes: StepNotes) -> None:
    """The same for single objects in ITEA versions, whose steps look for them in sub-models; these may be roots there."""
    for tree in models.active:
        place = _place_of(tree.root)
        if len(place) > 1:
            _wrap(tree, place, "AMALTHEA", notes)


def _place_of(root: Node) -> tuple[str, ...]:
    return _PLACES.get(root.tag) or _TYPED_PLACES.get(root.tag, ())


def _wrap(tree: Tree, place: tuple[str, ...], model: str, notes: StepNotes) -> None:
    part = tree.root
    notes.converted(part, "part of a model as root of a file -> whole model", part.tag)
    if part.tag in _TYPED_PLACES:
        part.type = part.tag
    holder = tree.root = Node(model, origin=part.origin)
    for tag in place[:-1]:
        holder = holder.add(tag)
    part.tag = place[-1]
    holder.insert(part)
