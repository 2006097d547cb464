"""0.8.3 -> 0.9.0: the hardware model was built anew; 0.9.0 -> 0.9.1: times in custom properties; 0.9.7 -> 0.9.8: units."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import ceil, floor

from amalthea_uros.xmi.migrate.steps.tools import attributes_text, whole_number
from amalthea_uros.xmi.migrate.steps.v0_9_0_clocks import Clocks, frequency_of
from amalthea_uros.xmi.migrate.steps.v0_9_0_definitions import INSTRUCTIONS, HardwareDefinitions, is_cache
from amalthea_uros.xmi.migrate.steps.v0_9_0_structures import Structures
from amalthea_uros.xmi.tree.classes import class_of
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

# References to hardware from other parts of the model

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


def convert_references(models: ModelSet, notes: StepNotes) -> None:
    """Rename the references to cores, and the classes of what is in no file; remove what cannot be referred to any more."""
    for tag, names in _TO_CORES.items():
        for node in models.nodes(tag):
            for old, new in names.items():
                if node.rename(old, new) and old != new:
                    notes.renamed(node, f"{old!r} -> {new!r}", attribute=old)
    for tag, name in _TO_MEMORIES.items():
        for node in models.nodes(tag):
            targets = node.references.get(name, [])
            lost = dict.fromkeys(filter(is_cache, targets))
            if lost:
                notes.lost(node, f"{name!r}: caches cannot be referred to", ", ".join(target.name for target in lost), name)
                node.references[name] = [target for target in targets if target not in lost]
                if not node.references[name]:
                    del node.references[name]
    for limit in models.nodes("limit"):
        context = limit.target("hardwareContext")
        if context is not None and class_of(context) not in ("Core", "ProcessingUnit"):
            del limit.references["hardwareContext"]
            notes.lost(limit, "'hardwareContext' other than a core", context.name, "hardwareContext")
    for node in models.proxies:
        node.target_class = _CLASSES.get(node.target_class, node.target_class)


# Access paths with latencies -> access elements of cores

_LATENCIES = {"R": ("readLatency",), "W": ("writeLatency",), "RW": ("readLatency", "writeLatency")}

#: Classes to which an access element may lead.
_DESTINATIONS = ("Memory", "ProcessingUnit")

#: How many paths a path may consist of, by references to other paths.
_MOST_INNER_PATHS = 50


class AccessPaths:
    """The conversion of access paths, after that of structures and quartzes."""

    def __init__(self, models: ModelSet, notes: StepNotes) -> None:
        self.models = models
        self.notes = notes
        self.inner_paths = 0

    def convert(self) -> None:
        """Convert all access paths."""
        paths = self.models.parts("hwModel", "accessPaths")
        made: dict[Node, list[Node]] = {}
        for path in paths:
            core, target = path.target("source"), path.target("target")
            if path.type != "LatencyAccessPath":
                self.notes.lost(path, "access path over hardware elements", path.name)
            elif core is not None and core.is_proxy:
                self.notes.lost(path, "access path whose source is not in the files", path.name)
            elif core is None or core.type != "ProcessingUnit":
                self.notes.lost(path, "access path from something other than a core", path.name)
            elif target is None or self._class_of(target) not in _DESTINATIONS:
                self.notes.lost(path, "access path to something other than a memory or core", path.name)
            else:
                made.setdefault(core, []).append(self._access_element(path, core, target))
        remove_all(paths)
        for core, elements in made.items():
            core.take(elements)

    def _class_of(self, node: Node) -> str:
        return node.target_class if node.is_proxy else node.type

    def _access_element(self, path: Node, core: Node, target: Node) -> Node:
        element = Node("accessElements", origin=path.origin)
        if path.name:
            element.attributes["name"] = path.name
        element.refer("destination", target)
        for latency in self.latencies(path, core):
            element.insert(latency)
        self.notes.converted(path, "access path -> access element of the core", path.name)
        return element

    def _make_latency(self, latency: Node, tag: str) -> None:
        latency.tag = tag
        for key in ("accessType", "transferSize"):
            latency.attributes.pop(key, None)
        latency.references.pop("quartz", None)
        latency.rename("value", "cycles")
        for deviation in latency.all("deviation"):
            deviation.tag = "cycles"

    def latencies(self, path: Node, core: Node) -> list[Node]:
        """One latency for reading and one for writing: all latencies on the way, those of paths that are part of it included."""
        costs: dict[str, list[Node]] = {"readLatency": [], "writeLatency": []}
        self.inner_paths = 0
        self._collect(path, core, costs, [])
        found = []
        for tag, latencies in costs.items():
            if latencies:
                latency = self._sum_of(latencies, path)
                self._make_latency(latency, tag)
                found.append(latency)
        return found

    def _collect(self, path: Node, core: Node, costs: dict[str, list[Node]], outer: list[Node]) -> None:
        for stated in path.all("latencies"):
            other = stated.target("ref")
            if other is not None:
                self._collect_inner(other, core, costs, [*outer, path])
            elif stated.get("value") or stated.child("deviation") is not None:
                access = stated.get("accessType", "_undefined_")
                if access not in _LATENCIES:
                    self.notes.defaulted(
                        stated, "latency without access type; assuming reading and writing", access, "accessType"
                    )
                if stated.get("transferSize", "0") != "0":
                    self.notes.lost(stated, "'transferSize' of latencies", stated.get("transferSize"), "transferSize")
                latency = self.in_cycles_of(core, stated)
                for tag in _LATENCIES.get(access, _LATENCIES["RW"]):
                    costs[tag].append(latency.copy())
            else:
                self.notes.lost(stated, "latency without value", path.name)

    def _collect_inner(self, path: Node, core: Node, costs: dict[str, list[Node]], outer: list[Node]) -> None:
        self.inner_paths += 1
        if path in outer or path.is_proxy or self.inner_paths > _MOST_INNER_PATHS:
            self.notes.lost(
                outer[0], "access path that is part of another one: not found, part of itself, or too many", path.name
            )
        else:
            self._collect(path, core, costs, outer)

    def _sum_of(self, latencies: list[Node], path: Node) -> Node:
        if len(latencies) == 1:
            return latencies[0]
        constants = [value for latency in latencies if (value := whole_number(latency.get("value"))) is not None]
        if len(constants) == len(latencies):
            latencies[0].attributes["value"] = str(sum(constants))
            self.notes.converted(path, "latencies of an access path: added up", " + ".join(map(str, constants)))
            return latencies[0]
        made = Node("latencies", "LatencyDeviation", origin=path.origin)
        deviation = made.add("deviation")
        for name in ("lowerBound", "upperBound"):
            bounds = [bound for latency in latencies if (bound := _bound(latency, name)) is not None]
            if len(bounds) == len(latencies):
                deviation.add(name, "LongObject", value=str(sum(bounds)))
        self.notes.converted(path, "latencies of an access path: only their bounds are added up", path.name)
        return made

    def in_cycles_of(self, core: Node, stated: Node) -> Node:
        """A copy of a latency in cycles of the core, which is what access elements state; it was in those of the quartz."""
        latency = stated.copy()
        quartz, domain = stated.target("quartz"), core.target("frequencyDomain")
        if quartz is None:
            self.notes.defaulted(stated, "latency without quartz; assuming cycles of the core", stated.get("value"), "quartz")
            return latency
        if quartz is domain:
            return latency
        from_frequency, to_frequency = frequency_of(quartz), frequency_of(domain)
        if not from_frequency or not to_frequency:
            self.notes.lost(
                stated, "'quartz' of latencies: its frequency or that of the core is unknown", quartz.name, "quartz"
            )
        elif from_frequency != to_frequency:
            factor = to_frequency / from_frequency
            _scale(latency, factor)
            self.notes.converted(stated, "latency in cycles of a quartz -> in cycles of the core", f"x {factor}", "quartz")
        return latency


def _bound(latency: Node, name: str) -> int | None:
    """A bound of a latency, which is the value of a constant one; None if it has none."""
    stated = next(iter(latency.find("deviation", name)), latency)
    return whole_number(stated.get("value"))


def _scale(latency: Node, factor: Fraction) -> None:
    for node in latency.walk():
        value = whole_number(node.get("value"))
        if value is not None:
            scaled = value * factor
            node.attributes["value"] = str(floor(scaled) if node.tag == "lowerBound" else ceil(scaled))


# Instructions of runnables -> execution needs with the key `Instructions`

_NEEDS = {"InstructionsConstant": "NeedConstant", "InstructionsDeviation": "NeedDeviation"}


def convert_instructions(models: ModelSet, notes: StepNotes) -> list[Node]:
    """Convert the instructions of runnables and schedulers, and return them."""
    found = models.of_type("RunnableInstructions")
    for item in found:
        item.type = "ExecutionNeed"
        for default in item.all("default"):
            _make_entry(default, notes)
        for extended in item.all("extended"):
            for value in extended.all("value"):
                _make_entry(value, notes)
        notes.converted(item, "instructions -> execution need with key 'Instructions'")
    return found


def _make_entry(instructions: Node, notes: StepNotes) -> None:
    """Put instructions as a need into an entry of the same tag."""
    if instructions.type not in _NEEDS and instructions.type:
        return
    entry = instructions.wrap(instructions.tag, key=INSTRUCTIONS)
    entry.comments, instructions.comments = instructions.comments, None
    instructions.tag = "value"
    kind = "InstructionsConstant" if instructions.child("deviation") is None else "InstructionsDeviation"
    instructions.type = _NEEDS[instructions.type or kind]
    for fetch in instructions.all("fetchStatistic"):
        if fetch.attributes or fetch.children:
            notes.lost(fetch, "'fetchStatistic' of instructions", attributes_text(fetch))
        fetch.remove()


def change_0_8_3(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.8.3."""
    convert_references(models, notes)
    clocks = Clocks(notes)
    clocks.convert_quartzes(models)
    definitions = HardwareDefinitions(models, notes)
    Structures(clocks, notes).convert(models)
    AccessPaths(models, notes).convert()
    definitions.convert()
    needs = convert_instructions(models, notes)
    if needs:
        definitions.need_category(needs[0])


STEP_0_9_0 = Step(
    "0.8.3",
    "0.9.0",
    change_0_8_3,
    frozenset(
        {
            *("accessPaths", "coreTypes", "ecus", "memoryTypes", "microcontrollers", "networkTypes", "quartzes", "system"),
            "RunnableInstructions",
        }
    ),
)


def change_0_9_0(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.9.0."""
    for node in models.of_type("TimeObject"):
        node.type = "Time"
        notes.renamed(node, "TimeObject -> Time")


STEP_0_9_1 = Step("0.9.0", "0.9.1", change_0_9_0, frozenset({"TimeObject"}))


# Units that old hardware models did not state, but meant

_UNSTATED = ("", "_undefined_")


def state_units(models: ModelSet, notes: StepNotes) -> None:
    """State that the frequencies of what was a quartz are in Hz, and the sizes of what was a memory type in bytes.

    APP4MC made both from plain numbers, without unit, and corrected its examples by hand in this sense. Its converters leave the unit
    open; so this is done after the last version for which their results are known.
    """
    labels = models.origins.labels

    def was(tag: str) -> Callable[[Node], bool]:
        return lambda node: node.origin >= 0 and labels[node.origin][0] == tag

    for tag, old, part, unit in (("domains", "quartzes", "defaultValue", "Hz"), ("definitions", "memoryTypes", "size", "B")):
        for holder in filter(was(old), models.parts("hwModel", tag)):
            quantity = holder.child(part)
            if quantity is not None and quantity.get("value") and quantity.get("unit") in _UNSTATED:
                quantity.attributes["unit"] = unit
                notes.defaulted(quantity, f"{part!r} without unit: in {unit}", quantity.get("value"), "unit")
