"""ITEA 1.3.0 -> 0.7.0: one namespace in the place of twelve, and names without the `is` of booleans."""

from __future__ import annotations

from functools import partial

from amalthea_uros.xmi.migrate.steps.file_roots import is_isr
from amalthea_uros.xmi.migrate.steps.tools import add_property, add_value
from amalthea_uros.xmi.tree.classes import local_name
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import BEYOND_ITEA, NoteKind, Postponed, StepNotes

# Attributes and features of hardware nodes -> custom properties

#: Classes of values -> those of custom properties.
_VALUES = {
    "BoolValue": "BooleanObject",
    "CharValue": "StringObject",
    "DoubleValue": "DoubleObject",
    "FeatureTypes": "StringObject",
    "IntValue": "IntegerObject",
    "LongValue": "LongObject",
    "StrValue": "StringObject",
}

#: Tags -> what the keys of their custom properties begin with.
_PREFIXES = {"attribute": "attribute#", "features": "feature#"}


def convert_values(models: ModelSet, notes: StepNotes) -> None:
    """Make the attributes and features of all hardware nodes custom properties."""
    converted = []
    for tag, prefix in _PREFIXES.items():
        for value in models.nodes(tag):
            holder = value.parent
            if holder is None or not _is_value(value):
                continue
            key, text = _key_of_value(value, prefix), value.attributes.get("value")
            if local_name(value.type) == "CharValue" and text is not None:
                text = _character(text, value, notes)
            value_class = _VALUES.get(local_name(value.type), "StringObject")
            content = Node("value", value_class, {} if text is None else {"value": text}, value.origin)
            made = add_value(holder, key, content)
            made.comments = value.comments
            notes.kept(value, f"{tag} of a hardware node: custom property", f"{made.get('key')}={text}")
            converted.append(value)
    remove_all(converted)


def _is_value(value: Node) -> bool:
    """Whether an element is an attribute or feature of hardware: others have the same tags."""
    return local_name(value.type) in _VALUES or (value.tag == "attribute" and not value.children)


def _key_of_value(value: Node, prefix: str) -> str:
    if local_name(value.type) == "FeatureTypes":
        prefix += "FeatureTypes#"
    name = value.attributes.get("name")
    if name is None:
        return prefix.removesuffix("#")
    return prefix + name


def _character(text: str, value: Node, notes: StepNotes) -> str:
    """The character that a code point stands for; the number itself if XML cannot hold it."""
    try:
        character = chr(int(text))
    except (ValueError, OverflowError):
        notes.kept(value, "character that is no code point: its text is kept", text, "value")
        return text
    return character if character.isprintable() or character in "\t\n\r" else text


#: Classes that did not only lose their package.
_CLASSES = {
    "hw:Component": "HwComponent",
    "hw:MemType": "MemoryType",
    "hw:Port": "HwPort",
    "hw:System": "HwSystem",
    "os:OSInstructions": "OsInstructions",
    "sw:OSEvent": "OsEvent",
    "sw:Periodic": "PeriodicActivation",
    # Where a file of a development version states no package, only unambiguous names tell it.
    "MemType": "MemoryType",
    "OSEvent": "OsEvent",
    "OSInstructions": "OsInstructions",
}

_ITEMS = {"isBuffered": "buffered"}

#: Attributes by class.
_BY_CLASS = {
    "ComplexPort": {"isMaster": "master"},
    "Group": {"isOrdered": "ordered"},
    "LabelAccess": _ITEMS,
    "SemaphoreAccess": {"accessEnum": "access"},
    "SenderReceiverRead": _ITEMS,
    "SenderReceiverWrite": _ITEMS,
}

#: Attributes of objects that state no class, by tag.
_BY_TAG = {"entries": {"isDefault": "default"}, "labels": _ITEMS, "mapping": {"mem": "memory"}}

_KINDS = {"PROVIDES": "provides", "REQUIRES": "requires"}

_TASK_ALLOCATION = ("taskAllocation", {"process": "task"})
_ISR_ALLOCATION = ("isrAllocation", {"process": "isr", "scheduler": "controller"})
_ALLOCATIONS = {"TaskAllocation": _TASK_ALLOCATION, "ISRAllocation": _ISR_ALLOCATION}


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA ITEA 1.3.0."""
    convert_values(models, notes)
    for port in models.nodes("ports"):
        if local_name(port.type) == "FInterfacePort":
            _convert_interface(port, notes)
    for allocation in models.nodes("processAllocation"):
        _split_allocation(models, allocation, notes)
    for definition in models.nodes("memTypeDefinitions"):
        definition.tag = "memoryTypeDefinitions"
        notes.renamed(definition, "memTypeDefinitions is memoryTypeDefinitions", definition.name)
    _rename(models, notes)


def _rename(models: ModelSet, notes: StepNotes) -> None:
    """The names of classes and attributes, in one go."""
    for root in models.roots:
        if root.tag == "AMALTHEA":
            root.tag = "Amalthea"
    by_class: dict[str, str] = {"": ""}
    for node in models.walk():
        renamed = _BY_TAG.get(node.tag)
        if node.type:
            type_name = local_name(node.type)
            renamed = _BY_CLASS.get(type_name, renamed)
            if node.type not in by_class:
                by_class[node.type] = _CLASSES.get(node.type, type_name)
            new = by_class[node.type]
            if new != type_name:
                notes.renamed(node, f"class {type_name} is {new}", node.name)
            node.type = new
        if node.target_class:
            node.target_class = _CLASSES.get(node.target_class, local_name(node.target_class))
        for old, name in renamed.items() if renamed else ():
            if node.rename(old, name):
                notes.renamed(node, f"{old} is {name}", attribute=old)
        if node.tag == "activations" and node.type == "Periodic":
            node.type = "PeriodicActivation"
    for node in models.proxies:
        node.target_class = _CLASSES.get(node.target_class, local_name(node.target_class))


def _convert_interface(port: Node, notes: StepNotes) -> None:
    kind = port.get("kind")
    if kind in _KINDS:
        port.attributes["kind"] = _KINDS[kind]
        notes.renamed(port, f"kind {kind} is {_KINDS[kind]}", port.name, "kind")
    for interface in port.references.pop("interface", ()):
        text = interface.get("path") if interface.is_proxy else interface.name
        add_property(port, "Franca interface", text)
        notes.kept(port, "reference to a Franca interface: custom property 'Franca interface'", text)


def _split_allocation(models: ModelSet, allocation: Node, notes: StepNotes) -> None:
    """`processAllocation` -> one of a task, or of an ISR."""
    known = _ALLOCATIONS.get(local_name(allocation.type))
    if known is None:
        process = allocation.target("process")
        known = _ISR_ALLOCATION if process is not None and is_isr(process) else _TASK_ALLOCATION
    allocation.tag, renamed = known
    allocation.type = ""
    for old, name in renamed.items():
        allocation.rename(old, name)
    notes.renamed(allocation, f"processAllocation is {allocation.tag}")
    _postpone_properties(models, allocation)


def _postpone_properties(models: ModelSet, allocation: Node) -> None:
    """Leave the custom properties out, as the published conversions do."""
    properties = allocation.all("customProperties")
    for part in properties:
        what = (part, f"{part.tag} of an allocation", part.get("key"))
        models.postponed.append(Postponed(BEYOND_ITEA, partial(_put_back, part, allocation), NoteKind.MOVED, *what))
    remove_all(properties)


def _put_back(properties: Node, allocation: Node) -> None:
    """Give an allocation a custom property back, which has missed that classes lost their packages."""
    for node in properties.walk():
        node.type = local_name(node.type)
    allocation.insert(properties, len(allocation.all("customProperties")))


STEP = Step("ITEA 1.3.0", "0.7.0", change, frozenset({"processAllocation", "memTypeDefinitions", "OSEvent", "MemType"}))
