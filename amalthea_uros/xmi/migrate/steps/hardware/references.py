"""References to hardware from other parts of the model."""

from __future__ import annotations

from amalthea_uros.metamodel.naming import encode
from amalthea_uros.xmi.migrate.classes import class_of
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, proxy
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.hardware.tools import hash_order, is_cache

#: Classes of objects that are in no file of the set.
_CLASSES = {
    "HwSystem": "HwStructure",
    "ECU": "HwStructure",
    "Microcontroller": "HwStructure",
    "Core": "ProcessingUnit",
    "CoreType": "ProcessingUnitDefinition",
    "MemoryType": "MemoryDefinition",
    "Network": "ConnectionHandler",
    "NetworkType": "ConnectionHandlerDefinition",
    "Bus": "ConnectionHandlerDefinition",
    "Bridge": "ConnectionHandlerDefinition",
    "CrossbarSwitch": "ConnectionHandlerDefinition",
    "Quartz": "FrequencyDomain",
    "ComplexPort": "HwPort",
}

#: Classes as the official converter writes them in custom properties: some are mixed up, some are missing.
_OFFICIAL_CLASSES = {
    **{name: _CLASSES[name] for name in ("HwSystem", "ECU", "Microcontroller", "MemoryType", "Quartz")},
    **{name: name for name in ("Bus", "Bridge", "CrossbarSwitch", "ComplexPort", "Memory")},
    "Core": "ProcessingUnitDefinition",
    "CoreType": "ProcessingUnit",
    "Network": "ConnectionHandlerDefinition",
    "NetworkType": "ConnectionHandler",
}

#: Tag -> references to cores, and how they are called now.
_TO_CORES = {
    "events": {"core": "processingUnit"},
    "taskAllocation": {"coreAffinity": "affinity"},
    "schedulerAllocation": {"responsibility": "responsibility", "executingCore": "executingPU"},
    "target": {"cores": "cores"},
}

#: Tag -> references to memories.
_TO_MEMORIES = {
    "memoryMapping": "memory",
    "physicalSectionMapping": "memory",
    "target": "memories",
    "physicalSectionConstraints": "memories",
}


class References:
    """The conversion of references, before that of the hardware."""

    def __init__(self, models: ModelSet, notes: Notes, official: bool) -> None:
        self.models = models
        self.notes = notes
        self.official = official
        #: References in custom properties, with the old classes of the targets.
        self.in_properties: list[tuple[Node, list[tuple[Node, str]]]] = []

    def convert(self) -> None:
        """Rename the references to cores; remove those to what cannot be referred to any more."""
        for tag, names in _TO_CORES.items():
            for node in self.models.nodes(tag):
                for old, new in names.items():
                    self._convert_to_cores(node, old, new)
        for tag, name in _TO_MEMORIES.items():
            for node in self.models.nodes(tag):
                self.check_memories(node, name)
        for node in self.models.nodes("limit"):
            self._check_hardware_context(node)
        if self.official:
            self._remember_properties()

    def _convert_to_cores(self, node: Node, old: str, new: str) -> None:
        if not node.rename(old, new):
            return
        if old != new:
            self.notes.renamed(node, f"{old!r} -> {new!r}", attribute=old)
        if self.official and new in node.references:
            node.references[new] = hash_order(dict.fromkeys(node.references[new]), encoded=True)

    def check_memories(self, node: Node, name: str) -> None:
        """Remove references to caches; the official converter also removes those to memories in none of the files."""
        targets = node.references.get(name)
        if targets is None:
            return
        lost = {target: None for target in targets if (self.official if target.is_proxy else self._becomes_cache(target))}
        if lost:
            words = "caches and memories in no file are not referred to" if self.official else "caches cannot be referred to"
            self.notes.lost(
                node,
                f"{name!r}: {words}",
                ", ".join(target.name or target.get("path") for target in lost),
                name,
            )
            node.references[name] = [target for target in targets if target not in lost]
            if not node.references[name]:
                del node.references[name]
        if self.official and name in node.references:
            node.references[name] = hash_order(dict.fromkeys(node.references[name]), encoded=True)

    def _becomes_cache(self, memory: Node) -> bool:
        # The official converter makes memories of the caches of cores, too.
        return is_cache(memory) and not (self.official and memory.enclosing("cores") is not None)

    def _check_hardware_context(self, limit: Node) -> None:
        context = limit.target("hardwareContext")
        if context is not None and class_of(context) not in ("Core", "ProcessingUnit"):
            del limit.references["hardwareContext"]
            self.notes.lost(limit, "'hardwareContext' other than a core", context.name, "hardwareContext")

    def convert_proxies(self) -> None:
        """Rename the classes of what is in none of the files."""
        for node in self.models.proxies:
            node.target_class = _CLASSES.get(node.target_class, node.target_class)

    # As the official converter does it

    def _remember_properties(self) -> None:
        for holder in self.models.nodes("customProperties"):
            for node in holder.walk():
                targets = node.references.get("value", [])
                if node.type == "ReferenceObject" and any(class_of(target) in _OFFICIAL_CLASSES for target in targets):
                    self.in_properties.append((node, [(target, class_of(target)) for target in targets]))

    def mix_up_properties(self) -> None:
        """Let custom properties refer to objects of the classes that the official converter writes, after the conversion."""
        if not self.in_properties:
            return
        existing: dict[tuple[str, str], Node] = {}
        for hardware in self.models.parts("hwModel"):
            for node in hardware.walk():
                existing.setdefault((node.name, class_of(node)), node)
        for node, targets in self.in_properties:
            node.references["value"] = [self._named(existing, target, old) for target, old in targets]

    def _named(self, existing: dict[tuple[str, str], Node], target: Node, old: str) -> Node:
        new = _OFFICIAL_CLASSES.get(old)
        if new is None:
            return target
        found = existing.get((target.name, new)) if not target.is_proxy else None
        if found is None:
            found = proxy(target.get("path") or encode(target.name), new)
            self.models.proxies.append(found)
        return found
