"""The hardware model.

In AMALTHEA sizes and latencies belong to definitions, which modules refer to; features of core types to categories; and connections
join ports. Definitions and ports are made as they are needed, one for each module or end of a connection.
"""

from __future__ import annotations

from typing import Any, TypeVar

from amalthea_uros.bridge.basics.codecs import FLOAT, FREQUENCY, RATE, SIZE, enumeration, reference, references, same_names
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable
from amalthea_uros.bridge.basics.kinds import ObjectKind
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

CLOCKS = ClassTable(ClassEntry(perf.Clock, am.FrequencyDomain, frequency=("default_value", FREQUENCY)))


#: What definitions say of modules.
_MEMORY = ClassEntry(
    perf.Memory,
    am.MemoryDefinition,
    kind=("memory_type", _MEMORY_KIND),
    size=SIZE,
    latency=("access_latency", TICKS),
    rate=("data_rate", RATE),
)
_CACHE = ClassEntry(perf.Cache, am.CacheDefinition, size=SIZE, latency=("access_latency", TICKS), hit_rate=FLOAT)
#: Connections, accesses and definitions of interconnects have it alike.
_LATENCY = ClassEntry(
    perf.Latency,
    am.HwConnection,
    read=("read_latency", TICKS),
    write=("write_latency", TICKS),
    rate=("data_rate", RATE),
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
        kind = _CORE_KIND.build_given(core_type.kind, self.context)
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
            structure_type=_STRUCTURE_KIND.build_given(structure.kind, self.context),
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
        element.definition = _CORE_TYPE.build(core.type, self.context)
        element.caches = [self.cache(cache) for cache in core.caches]
        return element

    def memory(self, memory: perf.Memory) -> am.HwModule:
        """A memory with a definition of its own."""
        element = self._module(am.Memory, memory)
        if any(getattr(memory, name) is not None for name in _MEMORY.columns):
            element.definition = am.MemoryDefinition(name=memory.name)
            _MEMORY.fill(element.definition, memory, self.context)
            self.definitions.append(element.definition)
        return element

    def cache(self, cache: perf.Cache) -> am.Cache:
        """A cache with a definition of its own."""
        element = self._module(am.Cache, cache)
        element.definition = am.CacheDefinition(name=cache.name)
        _CACHE.fill(element.definition, cache, self.context)
        self.definitions.append(element.definition)
        return element

    def interconnect(self, interconnect: perf.Interconnect) -> am.HwModule:
        """An interconnect with a definition of its own."""
        element = self._module(am.ConnectionHandler, interconnect)
        definition = am.ConnectionHandlerDefinition(name=interconnect.name)
        definition.policy = _ARBITRATION.build_given(interconnect.arbitration, self.context)
        _LATENCY.fill(definition, interconnect.latency, self.context)
        element.definition = definition
        self.definitions.append(definition)
        return element

    def _module(self, kind: type[M], item: perf.Core | perf.Memory | perf.Cache | perf.Interconnect) -> M:
        element = kind(name=item.name)
        self.context.register(item, element)
        self.context.at(item)
        element.frequency_domain = _CLOCK.build(item.clock, self.context)
        return element

    def join(self, connection: perf.Connection) -> None:
        """Give a connection its ports: it initiates at its source and is responded to at its target."""
        self.context.at(connection)
        element: Any = self.context.find(ObjectKind.MODULE, connection.name)
        source: Any = self.context.find(ObjectKind.MODULE, connection.source)
        target: Any = self.context.find(ObjectKind.MODULE, connection.target)
        _LATENCY.fill(element, connection.latency, self.context)
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
            _LATENCY.fill(found, access.latency, self.context)
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
            **self._module(element),
            type=_CORE_TYPE.extract(element.definition, self.context, element),
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
            memory=memory, latency=_LATENCY.complete(element, self.context), path=_MODULES.extract(path, self.context, element)
        )

    def memory(self, element: am.Memory) -> perf.Memory:
        """A memory with what its definition says."""
        definition = element.definition if isinstance(element.definition, am.MemoryDefinition) else am.MemoryDefinition()
        return perf.Memory(**self._module(element), **(_MEMORY.values(definition, self.context) or {}))

    def cache(self, element: am.Cache) -> perf.Cache:
        """A cache with what its definition says."""
        definition = element.definition if isinstance(element.definition, am.CacheDefinition) else am.CacheDefinition()
        return perf.Cache(**self._module(element), **(_CACHE.values(definition, self.context) or {}))

    def interconnect(self, element: am.ConnectionHandler) -> perf.Interconnect:
        """An interconnect with what its definition says."""
        definition = element.definition or am.ConnectionHandlerDefinition()
        return perf.Interconnect(
            **self._module(element),
            arbitration=_ARBITRATION.extract(definition.policy, self.context, element),
            latency=_LATENCY.complete(definition, self.context),
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
            latency=_LATENCY.complete(element, self.context),
        )

    def _module(self, element: am.HwModule) -> dict[str, Any]:
        """What all modules have."""
        return {
            "name": self.context.names[element],
            "origin": self.context.location(element),
            "clock": _CLOCK.extract(element.frequency_domain, self.context, element),
        }
