"""0.8.3 -> 0.9.0, hardware: definitions, frequency domains, ports, and structures with their modules."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import isfinite

from amalthea_uros.units import FREQUENCY
from amalthea_uros.xmi.data_types import format_double, parse_float
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import BEYOND_CONVERTERS, NoteKind, Postponed, StepNotes
from amalthea_uros.xmi.migrate.steps.tools import add_property, content_of, free_key, names_of

#: Values by which EMF states that nothing is stated.
_NOTHING = frozenset({"", "0", "0.0", "0x0", "false", "_undefined_"})


@dataclass(frozen=True)
class Shape:
    """What the successor of an object has a place for.

    Attributes
    ----------
    words : the kind of object, for messages; plural
    attributes, references, parts : names that it has; besides name, custom properties and tags
    """

    words: str
    attributes: frozenset[str] = frozenset()
    references: frozenset[str] = frozenset()
    parts: frozenset[str] = frozenset()

    def reduce(self, node: Node, notes: StepNotes) -> None:
        """Remove the rest, and report it."""
        shared = frozenset({"customProperties", "tags"})
        for key, text in list(node.attributes.items()):
            if key != "name" and key not in self.attributes:
                del node.attributes[key]
                if text.strip() not in _NOTHING:
                    notes.lost(node, f"{key!r} of {self.words}", text, key)
        for key, targets in list(node.references.items()):
            if key not in self.references | shared:
                del node.references[key]
                notes.lost(node, f"{key!r} of {self.words}", names_of(targets), key)
        superfluous = [part for part in node.children if part.tag not in self.parts | shared]
        for part in superfluous:
            notes.lost(part, f"{part.tag!r} of {self.words}", part.name or part.get("key") or content_of(part))
        remove_all(superfluous)


def keep_reference(node: Node, key: str, targets: Sequence[Node]) -> None:
    """State references as custom properties."""
    for target in targets:
        made = node.add("customProperties", at=_place_for_property(node), key=key)
        made.add("value", "ReferenceObject").refer("value", target)


def _place_for_property(node: Node) -> int:
    return next((at for at, part in enumerate(node.children) if part.tag != "customProperties"), len(node.children))


def is_cache(memory: Node) -> bool:
    """Whether a memory, not yet converted, becomes a cache."""
    memory_type = memory.target("type")
    return memory_type is not None and (memory_type.get("type") == "CACHE" or memory_type.type == "CacheDefinition")


def hash_order(nodes: Iterable[Node]) -> list[Node]:
    """Nodes in the order of a Java `HashMap` by name, in which APP4MC writes them."""
    held = list(nodes)
    buckets = 16
    while len(held) > 0.75 * buckets:
        buckets *= 2

    def bucket(node: Node) -> int:
        code = _java_hash(node.name)
        return (code ^ (code >> 16)) & (buckets - 1)

    return sorted(held, key=bucket)


def _java_hash(text: str) -> int:
    code = 0
    units = text.encode("utf-16-be", "surrogatepass")
    for at in range(0, len(units), 2):
        code = (31 * code + units[at] * 256 + units[at + 1]) & 0xFFFFFFFF
    return code


# Quartzes -> frequency domains; prescalers -> the domain of the quartz, or one of its own with the resulting frequency

_DOMAIN = Shape("quartzes", parts=frozenset({"defaultValue"}))
_HERTZ = {"": 1, "_undefined_": 1, **FREQUENCY.units}


class Clocks:
    """The frequency domains of a set of files."""

    def __init__(self, notes: StepNotes) -> None:
        self.notes = notes
        self.domains: dict[tuple[Node, str], Node] = {}
        self.names: set[str] = set()

    def convert_quartzes(self, models: ModelSet) -> None:
        """Make every quartz a frequency domain of its hardware model."""
        for hardware in models.parts("hwModel"):
            quartzes = [node for node in list(hardware.walk()) if node.tag == "quartzes" and self._is_convertible(node)]
            # The order has no meaning: that of APP4MC, so that results can be compared.
            hardware.take(hash_order(quartzes))
            for quartz in quartzes:
                self.notes.converted(quartz, "quartz -> frequency domain")
                self._convert_quartz(quartz)
        self.names = {node.name for node in models.parts("hwModel", "domains")}

    def _is_convertible(self, quartz: Node) -> bool:
        if quartz.name or quartz.children:
            return True
        self.notes.lost(quartz, "quartz without name")
        quartz.remove()
        return False

    def _convert_quartz(self, quartz: Node) -> None:
        quartz.tag, quartz.type = "domains", "FrequencyDomain"
        frequency = quartz.child("frequency")
        if frequency is not None:
            frequency.tag = "defaultValue"
        _DOMAIN.reduce(quartz, self.notes)

    def convert_prescaler(self, module: Node) -> None:
        """Replace the prescaler of a module by a reference to a frequency domain."""
        prescaler = module.child("prescaler")
        if prescaler is None:
            return
        prescaler.remove()
        quartz = prescaler.target("quartz")
        if quartz is None:
            if prescaler.get("clockRatio", "1.0") not in ("0.0", "1.0"):
                self.notes.lost(module, "clock ratio of a prescaler without quartz", prescaler.get("clockRatio"))
            return
        ratio = self.ratio(prescaler)
        if ratio is None:
            domain: Node | None = quartz
        elif quartz.tag == "domains":
            domain = self.domain(quartz, ratio)
        else:
            domain = None
        if domain is None:
            self.notes.lost(
                module, "prescaler: its quartz is not in the files", f"{quartz.get('path') or quartz.name} x {ratio}"
            )
            return
        module.refer("frequencyDomain", domain)
        self.notes.converted(module, "prescaler -> frequency domain", domain.name)

    def ratio(self, prescaler: Node) -> str | None:
        """The factor as text; None if the clock is that of the quartz."""
        text = prescaler.get("clockRatio")
        number = _number(text)
        if not text or number == 0:
            self.notes.defaulted(prescaler, "prescaler without clock ratio, or with ratio 0; assuming 1", text, "clockRatio")
            return None
        return None if number == 1 else text.strip()

    def domain(self, quartz: Node, ratio: str) -> Node:
        """The domain of the prescalers with that quartz and that ratio."""
        known = self.domains.get((quartz, ratio))
        if known is not None:
            return known
        made = self.domains[quartz, ratio] = quartz.copy()
        made.attributes["name"] = self._name(quartz, ratio)
        assert quartz.parent is not None
        quartz.parent.insert(made)
        frequency = made.child("defaultValue")
        if frequency is not None and "value" in frequency.attributes:
            factor, value = _number(ratio), _number(frequency.get("value"))
            if factor is not None and value is not None and factor > 0:
                frequency.attributes["value"] = format_double(value * factor)
            else:
                # It is not the frequency of the quartz either.
                words = "not a number" if factor is None or value is None else "negative"
                self.notes.lost(made, f"frequency after a prescaler: {words}", f"{frequency.get('value')} x {ratio}")
                frequency.remove()
        return made

    def _name(self, quartz: Node, ratio: str) -> str:
        """The name of the domain of a prescaler. References are names, so it must not be that of another domain."""
        name = free_key(f"{quartz.name}__{ratio}", self.names)
        self.names.add(name)
        return name


def frequency_of(domain: Node | None) -> Fraction | None:
    """The frequency of a domain in Hz, None if it is not known; without unit it is in Hz."""
    stated = domain.child("defaultValue") if domain is not None else None
    number = _number(stated.get("value")) if stated is not None else None
    scale = _HERTZ.get(stated.get("unit")) if stated is not None else None
    return Fraction(number) * scale if number and scale else None


def _number(text: str) -> float | None:
    try:
        number = parse_float(text)
    except ValueError:
        return None
    return number if isfinite(number) else None


# Types of cores, memories and networks -> definitions; instructions per cycle -> features

INSTRUCTIONS = "Instructions"

_CORE_TYPE = Shape("core types", frozenset({"puType"}), frozenset({"classifiers", "features"}))
_MEMORY_TYPE = Shape("memory types", references=frozenset({"classifiers"}), parts=frozenset({"size"}))
_CACHE_TYPE = Shape("cache types", parts=frozenset({"size"}))
_NETWORK_TYPE = Shape("network types", attributes=frozenset({"policy"}))

_POLICY = {"RROBIN": "RoundRobin", "PRIORITY": "PriorityBased"}

#: What the types of structures were; structures have no definitions.
_WITHOUT_SUCCESSOR = {"systemTypes": "system type", "ecuTypes": "ECU type", "mcTypes": "microcontroller type"}


class HardwareDefinitions:
    """The definitions of a set of files."""

    def __init__(self, models: ModelSet, notes: StepNotes) -> None:
        self.models = models
        self.notes = notes
        self.category: Node | None = None
        self.features: dict[str, Node] = {}
        for category in models.parts("hwModel", "featureCategories"):
            if category.name == INSTRUCTIONS:
                self.category = self.category or category
                self.features |= {feature.name: feature for feature in category.all("features")}

    def convert(self) -> None:
        """Convert the types of all hardware models."""
        for hardware in self.models.parts("hwModel"):
            # The order has no meaning: that of APP4MC, so that results can be compared.
            memory_types = hash_order(hardware.all("memoryTypes"))
            core_types, network_types = hardware.all("coreTypes"), hardware.all("networkTypes")
            hardware.take([*memory_types, *core_types, *network_types])
            for memory_type in memory_types:
                self._convert_memory_type(memory_type)
            for core_type in core_types:
                self._convert_core_type(core_type, hardware)
            for network_type in network_types:
                self._convert_network_type(network_type)
            self._remove_types_of_structures(hardware)

    def _convert_memory_type(self, node: Node) -> None:
        kind = node.attributes.pop("type", "_undefined_")
        if kind == "CACHE":
            node.tag, node.type = "definitions", "CacheDefinition"
            _CACHE_TYPE.reduce(node, self.notes)
            self.notes.converted(node, "memory type CACHE -> cache definition")
            return
        node.tag, node.type = "definitions", "MemoryDefinition"
        _MEMORY_TYPE.reduce(node, self.notes)
        self.notes.converted(node, "memory type -> memory definition")
        if kind != "_undefined_":
            self._keep_kind(node, kind)

    def _keep_kind(self, node: Node, kind: str) -> None:
        """Keep of which kind a memory is; newer versions have other kinds."""
        what = (node, "'type' of memory types", kind, "type")
        if not kind.startswith("FLASH_"):
            self.notes.lost(*what)
            return
        add_property(node, "memoryType", kind)
        self.notes.kept(*what)
        state = partial(node.attributes.setdefault, "memoryType", "FLASH")
        self.models.postponed.append(Postponed(BEYOND_CONVERTERS, state, NoteKind.CONVERTED, *what, is_kept=True))

    def _convert_core_type(self, node: Node, hardware: Node) -> None:
        node.tag, node.type = "definitions", "ProcessingUnitDefinition"
        node.attributes["puType"] = "CPU"
        cycles = node.attributes.pop("instructionsPerCycle", "")
        if cycles:
            node.refer("features", self.feature(cycles, node, hardware))
            self.notes.converted(
                node, "instructions per cycle -> feature of the category 'Instructions'", cycles, "instructionsPerCycle"
            )
        _CORE_TYPE.reduce(node, self.notes)
        self.notes.converted(node, "core type -> processing unit definition")

    def feature(self, cycles: str, node: Node, hardware: Node) -> Node:
        """The feature that states a number of instructions per cycle; its name has the text of the number."""
        name = f"IPC_{cycles}"
        made = self.features.get(name)
        if made is None:
            category = self.category or self._add_category(hardware, node)
            made = self.features[name] = category.add("features", like=node, name=name, value=cycles)
        return made

    def _add_category(self, hardware: Node, like: Node | None = None) -> Node:
        self.category = hardware.add("featureCategories", like=like, name=INSTRUCTIONS, featureType="performance")
        return self.category

    def need_category(self, item: Node) -> None:
        """Make sure that there is a category for the instructions of runnables; if there is no hardware, where they are."""
        if self.category is None:
            hardware = next(iter(self.models.parts("hwModel")), None) or item.root.add("hwModel")
            self._add_category(hardware)

    def _convert_network_type(self, node: Node) -> None:
        kind, node.tag, node.type = node.type, "definitions", "ConnectionHandlerDefinition"
        policy = node.attributes.pop("schedPolicy", "")
        if policy:
            node.attributes["policy"] = _POLICY.get(policy, "_undefined_")
        _NETWORK_TYPE.reduce(node, self.notes)
        self.notes.converted(node, "network type -> connection handler definition", kind)

    def _remove_types_of_structures(self, hardware: Node) -> None:
        removed = hardware.all(*_WITHOUT_SUCCESSOR)
        for node in removed:
            self.notes.lost(node, f"{_WITHOUT_SUCCESSOR[node.tag]}: structures have no definitions", node.name)
        remove_all(removed)


# Ports

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


# Systems, ECUs and microcontrollers -> structures; cores, memories and networks -> modules in them

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
