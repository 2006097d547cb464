"""0.8.3 -> 0.9.0, hardware: systems, ECUs and microcontrollers -> structures; what they contain -> modules with ports."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.steps.tools import add_property
from amalthea_uros.xmi.migrate.steps.v0_9_0_clocks import Clocks
from amalthea_uros.xmi.migrate.steps.v0_9_0_definitions import Shape, is_cache, keep_reference
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

_ATTRIBUTES = frozenset({"bitWidth", "portType", "priority", "portInterface"})
_PORT = Shape("ports", _ATTRIBUTES)
_INITIATOR = Shape("initiator ports", _ATTRIBUTES)

#: What is worth a custom property, where it says something. Addresses and cycles belong to what answers an access.
_KEPT = ("direction", "schedValue")
_KEPT_OF_RESPONDERS = ("readCycles", "writeCycles", "baseAddress", "addressRange", *_KEPT)
_SAYS_NOTHING = frozenset({"", "_undefined_", "0", "0x0"})


def convert_ports(node: Node, notes: StepNotes) -> None:
    """Convert the ports of a structure or module."""
    for port in node.all("ports"):
        port.type, port.target_class = "", "HwPort"
        master = port.attributes.pop("master", None)
        is_initiator = master is not None and master.strip().lower() == "true"
        if master is not None:
            port.attributes["portType"] = "initiator" if is_initiator else "responder"
            notes.converted(port, "'master' of ports -> 'portType'", f"{master} -> {port.get('portType')}", "master")
        _keep(port, _KEPT if is_initiator else _KEPT_OF_RESPONDERS, notes)
        (_INITIATOR if is_initiator else _PORT).reduce(port, notes)


def _keep(port: Node, names: tuple[str, ...], notes: StepNotes) -> None:
    for name in names:
        text = port.attributes.pop(name, "")
        # An address of 0 means something if there is a range.
        if text not in _SAYS_NOTHING or (name == "baseAddress" and text and port.get("addressRange") not in _SAYS_NOTHING):
            add_property(port, name, text)
            notes.kept(port, f"{name!r} of ports", text, name)
    network = port.references.pop("network", [])
    if network:
        keep_reference(port, "network", network)
        notes.kept(port, "'network' of ports", network[0].name, "network")


#: Tag -> type of the structure.
_STRUCTURES = {"system": "System", "ecus": "ECU", "microcontrollers": "Microcontroller"}

#: What may be inside of the parts of a structure: tag -> parts to search, in the order of APP4MC.
_SEARCHED = {"memories": ("memories", "networks", "components"), "networks": ("networks", "memories", "components")}

_STRUCTURE = Shape(
    "systems, ECUs and microcontrollers",
    attributes=frozenset({"structureType"}),
    parts=frozenset({"ports", "structures", "modules", "connections"}),
)
_REFERENCES = frozenset({"definition", "frequencyDomain", "powerDomain"})
_CORE = Shape("cores", references=_REFERENCES, parts=frozenset({"ports", "caches", "accessElements"}))
_MEMORY = Shape("memories", references=_REFERENCES, parts=frozenset({"ports"}))
_NETWORK = Shape("networks", references=_REFERENCES, parts=frozenset({"ports", "internalConnections"}))


class Structures:
    """The conversion of what the hardware consists of."""

    def __init__(self, clocks: Clocks, notes: StepNotes) -> None:
        self.clocks = clocks
        self.notes = notes
        #: What is converted, and what of it remains once its parts are where they belong.
        self.converted: list[tuple[Node, Shape]] = []

    def convert(self, models: ModelSet) -> None:
        """Convert all systems."""
        for hardware in models.parts("hwModel"):
            for structure in hardware.all(*_STRUCTURES):
                self.convert_structure(structure)
        for node, shape in self.converted:
            shape.reduce(node, self.notes)

    def convert_structure(self, node: Node) -> None:
        """Make a system, ECU or microcontroller a structure, with everything in it."""
        kind = _STRUCTURES[node.tag]
        inner, memories, networks = node.all(*_STRUCTURES), nested(node, "memories"), nested(node, "networks")
        if kind == "System":
            # Before its own modules: this is the order in which APP4MC makes frequency domains.
            self._convert_inner(inner)
        for memory in memories:
            self._convert_memory(memory)
        for network in networks:
            self._convert_network(network)
        if kind != "System":
            self._convert_inner(inner)
        modules = [*memories, *networks, *self.convert_cores(node.all("cores"))]
        for module in modules:
            if module.parent is not node:
                self.notes.moved(module, "module inside another one: moved into the structure", node.name)
        node.take(modules)
        convert_ports(node, self.notes)
        node.tag, node.type, node.target_class = "structures", "", "HwStructure"
        node.attributes["structureType"] = kind
        if not node.name and kind == "System" and _is_only_child(node):
            # A system needed no name, a structure does.
            node.attributes["name"] = kind
            self.notes.defaulted(node, "name of the structure that was a system without a name", kind, "name")
        self._finish(node, _STRUCTURE, f"{kind} -> structure")

    def _convert_inner(self, structures: list[Node]) -> None:
        for structure in structures:
            self.convert_structure(structure)

    def convert_cores(self, cores: list[Node]) -> list[Node]:
        """Make cores processing units; also returns what is in them, but cannot be in a processing unit."""
        parts = [(nested(core, "memories"), nested(core, "networks")) for core in cores]
        caches = {core: list(filter(is_cache, memories)) for core, (memories, _) in zip(cores, parts, strict=True)}
        modules = list(cores)
        for core in cores:
            self._convert_core(core, caches[core])
        taken = {cache for held in caches.values() for cache in held if cache.tag == "caches"}
        for memories, networks in parts:
            remaining = [memory for memory in memories if memory not in taken]
            for memory in remaining:
                self._convert_memory(memory)
            for network in networks:
                self._convert_network(network)
            modules += remaining + networks
        return modules

    def _convert_core(self, core: Node, caches: list[Node]) -> None:
        core.tag, core.type = "modules", "ProcessingUnit"
        group = core.attributes.pop("lockstepGroup", "0")
        if group != "0":
            add_property(core, "lockstepGroup", group)
            self.notes.kept(core, "'lockstepGroup' of cores", group, "lockstepGroup")
        self._convert_module(core, "coreType")
        for cache in caches:
            self._convert_memory(cache)
            cache.tag = "caches"
        core.take(caches)
        self._finish(core, _CORE, "core -> processing unit")

    def _convert_memory(self, memory: Node) -> None:
        kind = "Cache" if is_cache(memory) else "Memory"
        memory.tag, memory.type = "modules", kind
        self._convert_module(memory, "type")
        self._finish(memory, _MEMORY, f"memory -> {kind.lower()}")

    def _convert_network(self, network: Node) -> None:
        network.tag, network.type = "modules", "ConnectionHandler"
        self._convert_module(network, "type")
        self._finish(network, _NETWORK, "network -> connection handler")

    def _convert_module(self, module: Node, reference: str) -> None:
        definition = module.references.pop(reference, None)
        if definition:
            module.references["definition"] = definition
        self.clocks.convert_prescaler(module)
        convert_ports(module, self.notes)

    def _finish(self, node: Node, shape: Shape, message: str) -> None:
        self.notes.converted(node, message)
        self.converted.append((node, shape))


def nested(node: Node, tag: str) -> list[Node]:
    """The memories or networks of a node, also those inside its memories, networks and components."""
    found = node.all(tag)
    for part in (part for searched in _SEARCHED[tag] for part in node.all(searched)):
        below = part.walk()
        next(below)
        found += [inner for inner in below if inner.tag == tag]
    return found


def _is_only_child(node: Node) -> bool:
    """Whether no object beside a node can have the name that it gets."""
    return node.parent is not None and node.parent.all("system", "structures") == [node]
