"""The classes of objects that carry no `xsi:type`, by the tag of their element, and the names of objects in references."""

from __future__ import annotations

from amalthea_uros.metamodel.naming import TYPE_MARK, encode
from amalthea_uros.xmi.tree.node import Node

#: Tag -> classes that it stands for without `xsi:type`, in any version; only of objects that can be referred to. The first one is
#: the usual one.
_CLASSES: dict[str, tuple[str, ...]] = {
    "abstractionTypes": ("HwAbstractionType",),
    "caches": ("Cache",),
    "channels": ("Channel",),
    "classifiers": ("CoreClassifier", "MemoryClassifier"),
    "connections": ("HwConnection",),
    "componentInstances": ("ComponentInstance",),
    "components": ("Component", "HwComponent"),
    "connectors": ("Connector",),
    "coreClassifiers": ("CoreClassifier",),
    "coreTypeDefinitions": ("CoreType",),
    "coreTypes": ("CoreType",),
    "cores": ("Core",),
    "core": ("Core",),
    "ecuTypes": ("ECUType",),
    "ecus": ("ECU",),
    "eventChain": ("EventChain", "SubEventChain"),
    "eventChains": ("EventChain",),
    "events": ("OsEvent", "OSEvent"),
    "featureCategories": ("HwFeatureCategory",),
    "features": ("HwFeature",),
    "hwSystem": ("HwSystem", "System"),
    "interfaces": ("MainInterface", "ComponentInterface"),
    "interruptControllers": ("InterruptController",),
    "isrs": ("ISR",),
    "labels": ("Label",),
    "literals": ("ModeLiteral",),
    "localLabels": ("LocalModeLabel",),
    "mcTypes": ("MicrocontrollerType",),
    "memories": ("Memory",),
    "memoryClassifiers": ("MemoryClassifier",),
    "memoryTypeDefinitions": ("MemoryType", "MemType"),
    "memoryTypes": ("MemoryType", "MemType"),
    "memTypeDefinitions": ("MemType",),
    "microcontrollers": ("Microcontroller",),
    "modeLabels": ("ModeLabel",),
    "modes": ("Mode", "EnumMode", "NumericMode"),
    "modules": ("ProcessingUnit",),
    "namespaces": ("Namespace",),
    "networkTypes": ("NetworkType",),
    "networks": ("Network",),
    "nestedComponents": ("HwComponent", "Component"),
    "operatingSystems": ("OperatingSystem",),
    "osOverheads": ("OsOverhead", "OsInstructions", "OSInstructions"),
    "parameters": ("RunnableParameter",),
    "pins": ("Pin", "HwPin"),
    "ports": ("HwPort", "ComponentPort", "Port", "InterfacePort", "QualifiedPort"),
    "powerDomains": ("PowerDomain",),
    "prescaler": ("Prescaler",),
    "processChains": ("ProcessChain",),
    "processPrototypes": ("ProcessPrototype",),
    "quartzes": ("Quartz",),
    "runnables": ("Runnable",),
    "scheduler": ("TaskScheduler", "Scheduler"),
    "schedulerDefinitions": ("SchedulerDefinition",),
    "schedulingParameterDefinitions": ("SchedulingParameterDefinition",),
    "sections": ("Section", "PhysicalSectionConstraint"),
    "semaphores": ("Semaphore",),
    "structures": ("HwStructure", "ComponentStructure"),
    "subInterfaces": ("SubInterface",),
    "system": ("HwSystem", "System"),
    "systemTypes": ("SystemType",),
    "systems": ("Composite", "System"),
    "tags": ("Tag",),
    "taskSchedulers": ("TaskScheduler",),
    "tasks": ("Task",),
    "activations": (),
}


def may_be(node: Node, class_name: str) -> bool:
    """Whether a reference that names that class, with or without package, can mean the node."""
    if node.type:
        # ITEA versions have two classes `Periodic`: of stimuli and of activations.
        both = ":" in node.type and ":" in class_name
        return node.type == class_name if both else local_name(node.type) == local_name(class_name)
    known = _CLASSES.get(node.tag)
    return known is None or local_name(class_name) in known


def is_of(node: Node, class_name: str) -> bool:
    """Whether a node is known to be of a class (without package)."""
    return local_name(node.type) == class_name if node.type else class_name in _CLASSES.get(node.tag, ())


def class_of(node: Node) -> str:
    """The class by which references name an object, in ITEA versions with its package where that is known."""
    if node.type:
        return node.type
    return node.target_class or next(iter(_CLASSES.get(node.tag, ())), "")


def local_name(class_name: str) -> str:
    """The class without the package of ITEA versions."""
    return class_name.rpartition(":")[2]


# Names of objects in references, for versions before 0.9.7 and for what is in no file

#: Classes whose names are qualified by that of their container.
_QUALIFIED = {
    "ModeLiteral",
    "HwPort",
    "InterfacePort",
    "FInterfacePort",
    "HwFeature",
    "HwConnection",
    "ComponentInstance",
    "ComponentPort",
}


def reference_text(node: Node) -> str:
    """The text by which a reference names an object."""
    class_name = class_of(node)
    if node.is_proxy:
        path = node.attributes["path"]
    else:
        holder = node.parent.name if node.parent is not None and class_name in _QUALIFIED else ""
        path = f"{encode(holder)}/{encode(node.name)}" if holder else encode(node.name)
    if not class_name:
        return path
    # ITEA 1.3.0 qualifies the class by its package: `sw.Label`.
    return path + TYPE_MARK + class_name.replace(":", ".")
