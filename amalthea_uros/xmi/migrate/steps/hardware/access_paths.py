"""Access paths with latencies -> access elements of cores."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.hardware.clocks import frequency_of
from amalthea_uros.xmi.migrate.steps.hardware.tools import copy_of
from amalthea_uros.xmi.migrate.steps.numbers import whole_number

_LATENCIES = {"R": ("readLatency",), "W": ("writeLatency",), "RW": ("readLatency", "writeLatency")}

#: Classes to which an access element may lead.
_DESTINATIONS = ("Memory", "ProcessingUnit")

#: How many paths a path may consist of, by references to other paths.
_MOST_INNER_PATHS = 50


class AccessPaths:
    """The conversion of access paths, after that of structures and quartzes."""

    def __init__(self, models: ModelSet, notes: Notes) -> None:
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
                self.notes.lost(path, "access path from something in no file", path.name)
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
                        stated, "latency without access type: taken for reading and writing", access, "accessType"
                    )
                if stated.get("transferSize", "0") != "0":
                    self.notes.lost(stated, "'transferSize' of latencies", stated.get("transferSize"), "transferSize")
                latency = self.in_cycles_of(core, stated)
                for tag in _LATENCIES.get(access, _LATENCIES["RW"]):
                    costs[tag].append(copy_of(latency))
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
        latency = copy_of(stated)
        quartz, domain = stated.target("quartz"), core.target("frequencyDomain")
        if quartz is None:
            self.notes.defaulted(stated, "latency without quartz: taken as cycles of the core", stated.get("value"), "quartz")
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
