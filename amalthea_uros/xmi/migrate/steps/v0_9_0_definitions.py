"""0.8.3 -> 0.9.0, hardware: what successors have a place for, and types of cores, memories and networks as definitions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from amalthea_uros._internal.records import dataclass
from amalthea_uros.xmi.migrate.steps.tools import add_property, content_of, names_of
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import BEYOND_CONVERTERS, NoteKind, Postponed, StepNotes

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


# 0.8.3 -> 0.9.0, hardware: types of cores, memories and networks -> definitions; instructions per cycle -> features

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
