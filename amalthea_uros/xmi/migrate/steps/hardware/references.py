"""References to hardware from other parts of the model."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.classes import class_of
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.hardware.tools import is_cache

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

    def __init__(self, models: ModelSet, notes: Notes) -> None:
        self.models = models
        self.notes = notes

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

    def _convert_to_cores(self, node: Node, old: str, new: str) -> None:
        if not node.rename(old, new):
            return
        if old != new:
            self.notes.renamed(node, f"{old!r} -> {new!r}", attribute=old)

    def check_memories(self, node: Node, name: str) -> None:
        """Remove references to caches."""
        targets = node.references.get(name, ())
        lost = dict.fromkeys(filter(is_cache, targets))
        if lost:
            names = ", ".join(target.name for target in lost)
            self.notes.lost(node, f"{name!r}: caches cannot be referred to", names, name)
            node.references[name] = [target for target in targets if target not in lost]
            if not node.references[name]:
                del node.references[name]

    def _check_hardware_context(self, limit: Node) -> None:
        context = limit.target("hardwareContext")
        if context is not None and class_of(context) not in ("Core", "ProcessingUnit"):
            del limit.references["hardwareContext"]
            self.notes.lost(limit, "'hardwareContext' other than a core", context.name, "hardwareContext")

    def convert_proxies(self) -> None:
        """Rename the classes of what is in none of the files."""
        for node in self.models.proxies:
            node.target_class = _CLASSES.get(node.target_class, node.target_class)
