"""Details that only AMALTHEA models state, and that projects can have: spelling of quantities, ports, caches, callback servers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.inchron.facts import features
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import bits, hertz, picoseconds
from amalthea_uros.metamodel.model import Model

#: Interfaces of memory buses; the importer of INCHRON leaves out what connects others (am2inc, hwModel.cpp).
_MEMORY_INTERFACES = {am.PortInterface.AXI, am.PortInterface.AHB, am.PortInterface.APB, am.PortInterface.CUSTOM}
_INITIATOR, _RESPONDER = am.PortType.INITIATOR, am.PortType.RESPONDER

#: Custom properties that the importer of INCHRON knows (am2inc, swModel.cpp and activityGraph.cpp).
_SERVER, _POLICY = "callbackServer", "dispatchingPolicy"


@dataclass(frozen=True, slots=True, kw_only=True)
class AmaltheaDetails:
    """The details of a model.

    Attributes
    ----------
    units : of each quantity, by the name of the object that states it and the value in the internal unit
    modules : processing units, memories, caches and connection handlers
    handlers : names of the connection handlers that are memory buses
    servers : dispatching policies of the groups of callback servers, by the names of task and group
    """

    units: Mapping[tuple[str, int], str] = field(default_factory=dict)
    modules: tuple[Any, ...] = ()
    connections: tuple[Any, ...] = ()
    handlers: frozenset[str] = frozenset()
    servers: Mapping[str, Mapping[str, str]] = field(default_factory=dict)


def details_of(model: Model) -> AmaltheaDetails:
    """The details of a model that its system does not have."""
    units: dict[tuple[str, int], str] = {}
    modules: list[Any] = []
    connections: list[Any] = []
    servers: dict[str, dict[str, str]] = {}
    waiting: list[tuple[Element, str]] = [(document.root, "") for document in model.documents]
    while waiting:
        element, name = waiting.pop()
        for part in element.contents():
            value = _value(part)
            if value is not None:
                units.setdefault((name, value), str(part.unit))  # type: ignore[attr-defined]
            waiting.append((part, part.__dict__.get("name") or name))
        if isinstance(element, am.HwModule | am.Cache):
            modules.append(element)
        elif isinstance(element, am.HwConnection):
            connections.append(element)
        elif isinstance(element, am.Task) and _property(element, _SERVER) is True:
            servers[name] = _policies(element)
    handlers = frozenset(each.name or "" for each in modules if isinstance(each, am.ConnectionHandler) and _is_memory_bus(each))
    return AmaltheaDetails(
        units=units, modules=tuple(modules), connections=tuple(connections), handlers=handlers, servers=servers
    )


def _is_memory_bus(handler: am.ConnectionHandler) -> bool:
    return bool(handler.ports) and handler.ports[0].port_interface in _MEMORY_INTERFACES


def _value(element: Element) -> int | None:
    match element:
        case am.Time():
            return picoseconds(element)
        case am.DataSize():
            return bits(element)
        case am.Frequency():
            frequency = hertz(element)
            return None if frequency is None else int(frequency)
    return None


def _property(element: Any, key: str) -> Any:
    return next(
        (each.value.value for each in element.custom_properties if each.key == key and hasattr(each.value, "value")), None
    )


def _policies(task: am.Task) -> dict[str, str]:
    result = {}
    for group in task.activity_graph.items if task.activity_graph else ():
        if isinstance(group, am.Group):
            policy = _property(group, _POLICY)
            result[group.name or ""] = policy if policy in ("FIFO", "LIFO", "Priority") else "FIFO"
    return result


def add_details(model: ProjectObject, details: AmaltheaDetails) -> None:
    """Complete a project: ports with their widths, connections, caches, callback servers."""
    holders = {item.name: item for cpu in model["cpus"] for item in (*cpu["cores"], *cpu["memories"], *cpu["interconnects"])}
    holders |= {item.name: item for item in (*model["memories"], *model["interconnects"])}
    ports: dict[Any, ProjectObject] = {}
    for module in details.modules:
        if (holder := holders.get(module.name or "")) is not None:
            _add_ports(holder, module, ports)
            if isinstance(module, am.Cache) and module.definition is not None:
                _complete_cache(holder, module.definition)
    for connection in details.connections:
        ends = {port.port_type: ports[port] for port in (connection.port1, connection.port2) if port in ports}
        if {_INITIATOR, _RESPONDER} <= ends.keys():
            ends[_INITIATOR]["responder"] = ends[_RESPONDER]
    for process in (item for item in model.walk() if item.kind == "Process" and item.name in details.servers):
        process["server"] = True
        for entry in process["callGraph"]["graphEntries"]:
            if entry.kind == "CallSequence" and entry.name in details.servers[process.name]:
                entry["serviceContainer"], entry["dispatchingPolicy"] = True, details.servers[process.name][entry.name]


def _add_ports(holder: ProjectObject, module: Any, ports: dict[Any, ProjectObject]) -> None:
    is_handler = holder.kind == "memory.Interconnect"
    for port in module.ports:
        role = {_INITIATOR: "initiator", _RESPONDER: "responder"}.get(port.port_type)
        if role is None or (not is_handler and role not in features(holder.kind)):
            continue
        # Of a core or memory there is one port, which the others are, too.
        made = (None if is_handler else holder[role]) or ProjectObject(f"memory.{role.capitalize()}Port")
        made["name"] = port.name or role
        if role == "initiator" and port.priority:
            made["priority"] = port.priority
        if is_handler:
            holder.add(f"{role}s", made)
        else:
            holder[role] = made
            # The importer takes the bits of AMALTHEA for bytes here.
            holder["bitWidth"] = ProjectObject("DataSize", value=port.bit_width or 0, unit="B")
        ports[port] = made
    if is_handler and module.ports:
        most = max(port.bit_width or 0 for port in module.ports)
        holder["bitWidth"] = ProjectObject("DataSize", value=most, unit="bit")


def _complete_cache(holder: ProjectObject, definition: am.CacheDefinition) -> None:
    if (line := bits(definition.line_size)) is not None:
        holder["lineSize"] = ProjectObject("DataSize", value=line, unit="bit")
    kinds: dict[am.CacheType | None, str] = {am.CacheType.INSTRUCTION: "Instruction", am.CacheType.DATA: "Data"}
    kind = kinds.get(definition.cache_type)
    holder["cacheType"] = kind or "Unified"
    holder["writePolicy"] = "WriteBack" if definition.write_strategy is am.WriteStrategy.WRITEBACK else "WriteThrough"
    holder["coherency"] = bool(definition.coherency)
