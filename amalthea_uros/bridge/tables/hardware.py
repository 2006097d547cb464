"""The hardware model.

In AMALTHEA sizes and latencies belong to definitions, which modules refer to; features of core types to categories; and connections
join ports. Definitions and ports are made as they are needed, one for each module or end of a connection.
"""

from __future__ import annotations

from typing import Any, TypeVar

from amalthea_uros.bridge.codecs import FREQUENCY, RATE, SIZE, enumeration, reference, references, same_names
from amalthea_uros.bridge.context import Building, Extracting
from amalthea_uros.bridge.entries import ClassEntry, ClassTable, Column
from amalthea_uros.bridge.kinds import ObjectKind
from amalthea_uros.bridge.tables.distributions import TICKS
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import hardware as perf

M = TypeVar("M", bound=am.HwModule)

_CORE_KIND = same_names(perf.CoreKind, am.PuType)
_MEMORY_KIND = same_names(perf.MemoryKind, am.MemoryType)
_STRUCTURE_KIND = same_names(perf.StructureKind, am.StructureType)
_ARBITRATION = enumeration(
    {
        perf.Arbitration.ROUND_ROBIN: am.SchedPolicy.ROUND_ROBIN,
        perf.Arbitration.FIRST_COME: am.SchedPolicy.FCFS,
        perf.Arbitration.PRIORITY: am.SchedPolicy.PRIORITY_BASED,
    }
)
_CLOCK, _CORE_TYPE, _MODULE = reference(ObjectKind.CLOCK), reference(ObjectKind.CORE_TYPE), reference(ObjectKind.MODULE)
_MODULES = references(ObjectKind.MODULE)

CLOCKS = ClassTable(ClassEntry(perf.Clock, am.FrequencyDomain, frequency=Column("default_value", FREQUENCY)))


def _set_latency(element: Any, latency: perf.Latency, context: Building) -> None:
    if latency.read is not None:
        element.read_latency = TICKS.build(latency.read, context)
    if latency.write is not None:
        element.write_latency = TICKS.build(latency.write, context)
    if latency.rate is not None:
        element.data_rate = RATE.build(latency.rate, context)


def _latency(element: Any, context: Extracting) -> perf.Latency:
    read, write = element.read_latency, element.write_latency
    return perf.Latency(
        read=None if read is None else TICKS.extract(read, context, element),
        write=None if write is None else TICKS.extract(write, context, element),
        rate=RATE.extract(element.data_rate, context, element),
    )


class HardwareBuilder:
    """Builds the hardware model."""

    def __init__(self, context: Building) -> None:
        self.context = context
        self.definitions: list[am.HwDefinition] = []
        self.categories: dict[str, am.HwFeatureCategory] = {}
        self._ports: dict[Element, list[am.HwPort]] = {}

    def build(self, hardware: perf.Hardware) -> am.HWModel:
        """The whole model."""
        clocks: Any = CLOCKS.create_all(hardware.clocks, self.context)
        CLOCKS.fill(clocks, hardware.clocks, self.context)
        for core_type in hardware.core_types:
            self.core_type(core_type)
        # Connections may join modules of different structures, and accesses may lead anywhere: modules come first.
        structures = [self.structure(structure) for structure in hardware.structures]
        for structure in hardware.walk():
            for connection in structure.connections:
                self.join(connection)
            for core in structure.cores:
                self.accesses(core)
        return am.HWModel(
            feature_categories=list(self.categories.values()),
            definitions=self.definitions,
            structures=structures,
            domains=clocks,
        )

    def core_type(self, core_type: perf.CoreType) -> None:
        """A type of core, and its features in their categories."""
        features = []
        for feature in core_type.features:
            category = self.categories.setdefault(feature.category, am.HwFeatureCategory(name=feature.category))
            known = next((f for f in category.features if f.name == feature.name and f.value == feature.value), None)
            if known is None:
                known = am.HwFeature(name=feature.name, value=float(feature.value))
                category.features.append(known)
            features.append(known)
        kind = None if core_type.kind is None else _CORE_KIND.build(core_type.kind, self.context)
        definition = am.ProcessingUnitDefinition(name=core_type.name, pu_type=kind, features=features)
        self.context.register(core_type, definition)
        self.definitions.append(definition)

    def structure(self, structure: perf.Structure) -> am.HwStructure:
        """A structure with everything in it."""
        modules = [
            *map(self.core, structure.cores),
            *map(self.memory, structure.memories),
            *map(self.cache, structure.caches),
            *map(self.interconnect, structure.interconnects),
        ]
        element = am.HwStructure(
            name=structure.name,
            structure_type=None if structure.kind is None else _STRUCTURE_KIND.build(structure.kind, self.context),
            structures=[self.structure(inner) for inner in structure.structures],
            modules=modules,
        )
        self.context.register(structure, element)
        for connection in structure.connections:
            link = am.HwConnection(name=connection.name)
            self.context.register(connection, link)
            element.connections.append(link)
        return element

    def core(self, core: perf.Core) -> am.HwModule:
        """A core with its caches; what it accesses is not known yet."""
        element = self._module(am.ProcessingUnit, core)
        if core.type is not None:
            element.definition = _CORE_TYPE.build(core.type, self.context)
        element.caches = [self.cache(cache) for cache in core.caches]
        return element

    def memory(self, memory: perf.Memory) -> am.HwModule:
        """A memory with a definition of its own."""
        element = self._module(am.Memory, memory)
        if (memory.size, memory.kind, memory.latency, memory.rate) != (None, None, None, None):
            element.definition = am.MemoryDefinition(
                name=memory.name,
                size=SIZE.build(memory.size, self.context),
                memory_type=None if memory.kind is None else _MEMORY_KIND.build(memory.kind, self.context),
                access_latency=None if memory.latency is None else TICKS.build(memory.latency, self.context),
                data_rate=RATE.build(memory.rate, self.context),
            )
            self.definitions.append(element.definition)
        return element

    def cache(self, cache: perf.Cache) -> am.Cache:
        """A cache with a definition of its own."""
        element = self._module(am.Cache, cache)
        element.definition = am.CacheDefinition(
            name=cache.name,
            size=SIZE.build(cache.size, self.context),
            access_latency=None if cache.latency is None else TICKS.build(cache.latency, self.context),
            hit_rate=float(cache.hit_rate),
        )
        self.definitions.append(element.definition)
        return element

    def interconnect(self, interconnect: perf.Interconnect) -> am.HwModule:
        """An interconnect with a definition of its own."""
        element = self._module(am.ConnectionHandler, interconnect)
        definition = am.ConnectionHandlerDefinition(name=interconnect.name)
        if interconnect.arbitration is not None:
            definition.policy = _ARBITRATION.build(interconnect.arbitration, self.context)
        _set_latency(definition, interconnect.latency, self.context)
        element.definition = definition
        self.definitions.append(definition)
        return element

    def _module(self, kind: type[M], item: perf.Core | perf.Memory | perf.Cache | perf.Interconnect) -> M:
        element = kind(name=item.name)
        self.context.register(item, element)
        self.context.at(item)
        if item.clock is not None:
            element.frequency_domain = _CLOCK.build(item.clock, self.context)
        return element

    def join(self, connection: perf.Connection) -> None:
        """Give a connection its ports: it initiates at its source and is responded to at its target."""
        self.context.at(connection)
        element: Any = self.context.find(ObjectKind.MODULE, connection.name)
        source: Any = self.context.find(ObjectKind.MODULE, connection.source)
        target: Any = self.context.find(ObjectKind.MODULE, connection.target)
        _set_latency(element, connection.latency, self.context)
        if source is not None and target is not None:
            element.port1 = self._port(source, connection, am.PortType.INITIATOR)
            element.port2 = self._port(target, connection, am.PortType.RESPONDER)

    def _port(self, module: Any, connection: perf.Connection, kind: am.PortType) -> am.HwPort | None:
        if not isinstance(module, am.HwModule):
            self.context.refuse(connection, f"a connection cannot end at {module.name!r}")
            return None
        # Nothing is known of the width; one that is not zero is what other tools ask for.
        port = am.HwPort(name=connection.name, port_type=kind, port_interface=am.PortInterface.CUSTOM, bit_width=32)
        module.ports.append(port)
        return port

    def accesses(self, core: perf.Core) -> None:
        """What a core accesses."""
        self.context.at(core)
        element: Any = self.context.find(ObjectKind.MODULE, core.name)
        for access in core.accesses:
            found = am.HwAccessElement(name=access.memory, destination=_MODULE.build(access.memory, self.context))
            _set_latency(found, access.latency, self.context)
            if access.path:
                found.access_path = am.HwAccessPath(path_elements=_MODULES.build(access.path, self.context))
            element.access_elements.append(found)


class HardwareExtractor:
    """Extracts the hardware model."""

    def __init__(self, context: Extracting) -> None:
        self.context = context

    def extract(self, model: am.HWModel) -> perf.Hardware:
        """The whole model."""
        clocks = [domain for domain in model.domains if isinstance(domain, am.FrequencyDomain)]
        definitions = [d for d in model.definitions if isinstance(d, am.ProcessingUnitDefinition)]
        return perf.Hardware(
            clocks=CLOCKS.extract_all(clocks, self.context),
            core_types=tuple(map(self.core_type, definitions)),
            structures=tuple(map(self.structure, model.structures)),
        )

    def core_type(self, definition: am.ProcessingUnitDefinition) -> perf.CoreType:
        """A type of core with its features."""
        features = []
        for feature in definition.features:
            category = feature.container
            if isinstance(category, am.HwFeatureCategory):
                features.append(perf.Feature(category=category.name or "", name=feature.name or "", value=feature.value or 0.0))
        return perf.CoreType(
            name=self.context.names[definition],
            origin=self.context.location(definition),
            kind=_CORE_KIND.extract(definition.pu_type, self.context, definition),
            features=tuple(features),
        )

    def structure(self, element: am.HwStructure) -> perf.Structure:
        """A structure with everything in it."""
        modules = element.modules
        return perf.Structure(
            name=self.context.names[element],
            origin=self.context.location(element),
            kind=_STRUCTURE_KIND.extract(element.structure_type, self.context, element),
            structures=tuple(map(self.structure, element.structures)),
            cores=tuple(self.core(m) for m in modules if isinstance(m, am.ProcessingUnit)),
            memories=tuple(self.memory(m) for m in modules if isinstance(m, am.Memory)),
            caches=tuple(self.cache(m) for m in modules if isinstance(m, am.Cache)),
            interconnects=tuple(self.interconnect(m) for m in modules if isinstance(m, am.ConnectionHandler)),
            connections=tuple(found for c in self._connections(element) if (found := self.connection(c)) is not None),
        )

    def _connections(self, element: am.HwStructure) -> list[am.HwConnection]:
        """Those of the structure, and those inside its interconnects, which lead from one of their ports to another."""
        inside = [c for m in element.modules if isinstance(m, am.ConnectionHandler) for c in m.internal_connections]
        return [*element.connections, *inside]

    def core(self, element: am.ProcessingUnit) -> perf.Core:
        """A core with its caches and what it accesses."""
        accesses = (self.access(access) for access in element.access_elements)
        return perf.Core(
            name=self.context.names[element],
            origin=self.context.location(element),
            type=_CORE_TYPE.extract(element.definition, self.context, element),
            clock=self._clock(element),
            accesses=tuple(access for access in accesses if access is not None),
            caches=tuple(map(self.cache, element.caches)),
        )

    def access(self, element: am.HwAccessElement) -> perf.Access | None:
        """What an access costs; None, with a note, if it leads nowhere."""
        memory = _MODULE.extract(element.destination, self.context, element)
        if memory is None:
            self.context.note("EXT004", "HwAccessElement ignored: it has no destination", element)
            return None
        path = element.access_path.path_elements if element.access_path else []
        return perf.Access(
            memory=memory, latency=_latency(element, self.context), path=_MODULES.extract(path, self.context, element)
        )

    def memory(self, element: am.Memory) -> perf.Memory:
        """A memory with what its definition says."""
        definition: Any = element.definition if isinstance(element.definition, am.MemoryDefinition) else am.MemoryDefinition()
        latency = definition.access_latency
        return perf.Memory(
            name=self.context.names[element],
            origin=self.context.location(element),
            clock=self._clock(element),
            kind=_MEMORY_KIND.extract(definition.memory_type, self.context, element),
            size=SIZE.extract(definition.size, self.context, element),
            latency=None if latency is None else TICKS.extract(latency, self.context, element),
            rate=RATE.extract(definition.data_rate, self.context, element),
        )

    def cache(self, element: am.Cache) -> perf.Cache:
        """A cache with what its definition says."""
        definition: Any = element.definition if isinstance(element.definition, am.CacheDefinition) else am.CacheDefinition()
        latency = definition.access_latency
        return perf.Cache(
            name=self.context.names[element],
            origin=self.context.location(element),
            clock=self._clock(element),
            size=SIZE.extract(definition.size, self.context, element),
            latency=None if latency is None else TICKS.extract(latency, self.context, element),
            hit_rate=definition.hit_rate or 0.0,
        )

    def interconnect(self, element: am.ConnectionHandler) -> perf.Interconnect:
        """An interconnect with what its definition says."""
        definition: Any = element.definition or am.ConnectionHandlerDefinition()
        return perf.Interconnect(
            name=self.context.names[element],
            origin=self.context.location(element),
            clock=self._clock(element),
            arbitration=_ARBITRATION.extract(definition.policy, self.context, element),
            latency=_latency(definition, self.context),
        )

    def connection(self, element: am.HwConnection) -> perf.Connection | None:
        """A connection between two modules; None if an end is missing or belongs to no module, as ports of structures do."""
        ends = [port.container if port is not None else None for port in (element.port1, element.port2)]
        if element.port1 is not None and element.port1.port_type is am.PortType.RESPONDER:
            ends.reverse()
        source, target = (self.context.names.get(end) if isinstance(end, am.HwModule) else None for end in ends)
        if source is None or target is None:
            self.context.leave_out(element)
            self.context.drop(element)
            return None
        return perf.Connection(
            name=self.context.names[element],
            origin=self.context.location(element),
            source=source,
            target=target,
            latency=_latency(element, self.context),
        )

    def _clock(self, element: am.HwModule) -> str | None:
        name: str | None = _CLOCK.extract(element.frequency_domain, self.context, element)
        return name
