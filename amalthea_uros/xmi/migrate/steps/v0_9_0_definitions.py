"""0.8.3 -> 0.9.0, hardware: types of cores, memories and networks -> definitions; instructions per cycle -> features."""

from __future__ import annotations

from functools import partial

from amalthea_uros.xmi.migrate.steps.tools import add_property
from amalthea_uros.xmi.migrate.steps.v0_9_0_shapes import Shape, hash_order
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import BEYOND_CONVERTERS, NoteKind, Postponed, StepNotes

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
