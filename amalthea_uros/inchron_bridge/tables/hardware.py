"""Clocks, cores, memories, and the interconnects between them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.basics.values import frequency, time
from amalthea_uros.perf import hardware as perf
from amalthea_uros.units import NANOSECOND, SECOND

#: What the importer of INCHRON makes for stimuli: a clock without drift.
IDEAL_CLOCK = "IdealClock"

_NAME, _BITS, _WIDE_BITS = "New Project", 64, 256
#: Nothing in a model names these; the importer gives them these names (am2inc, relax.cpp).
_RESPONDER = "ResponderPort"


def build_hardware(context: Exporting, buses: frozenset[str]) -> None:
    """Make the clocks, processors, memories and interconnects.

    Parameters
    ----------
    buses : names of the interconnects that a project has; others are latencies only
    """
    system, model = context.system, context.model
    names = [structure.name for structure in system.hardware.walk() if structure.kind is perf.StructureKind.SYSTEM]
    model["name"] = names[-1] if names else _NAME
    for clock in system.hardware.clocks:
        if clock.frequency is None:
            context.changed(clock, "a clock without a frequency", "without one; tools may take 1 GHz for it")
        made = None if clock.frequency is None else _frequency(clock, context)
        model.add("clocks", context.register("Clock", clock.name, ProjectObject("Clock", name=clock.name, frequency=made)))
    free = IDEAL_CLOCK if IDEAL_CLOCK not in system.clocks else f"{IDEAL_CLOCK}_0"
    ideal = ProjectObject("Clock", name=free, period=time(NANOSECOND), range=time(SECOND))
    model.add("clocks", context.register("IdealClock", "", ideal))
    for structure in system.hardware.walk():
        if structure.cores:
            model.add("cpus", _cpu(structure, context, buses))
            continue
        for memory in structure.memories:
            model.add("memories", _memory(memory, ideal, context))
        for interconnect in (each for each in structure.interconnects if each.name in buses):
            model.add("interconnects", _interconnect(interconnect, ideal, context))


def _frequency(clock: perf.Clock, context: Exporting) -> ProjectObject:
    hertz = clock.frequency or Fraction(0)
    return frequency(hertz, context.units.get((clock.name, int(hertz))))


def _cpu(structure: perf.Structure, context: Exporting, buses: frozenset[str]) -> ProjectObject:
    system = context.system
    clocks = [core.clock for core in structure.cores if core.clock is not None and core.clock in system.clocks]
    fastest = max(clocks, key=lambda name: system.clocks[name].frequency or 0) if clocks else None
    clock = context.find("Clock", fastest) or context.find("IdealClock", "")
    if fastest is None:
        context.changed(structure, "a processor without a clock", f"with the clock {IDEAL_CLOCK}")
    cpu = ProjectObject("Cpu", name=structure.name, clock=clock, cpuModel="generic", reloadCpuModel=True)
    for core in structure.cores:
        cpu.add("cores", _core(core, system.frequency_of(fastest), context))
    for memory in structure.memories:
        cpu.add("memories", _memory(memory, clock, context))
    for cache in (*structure.caches, *(cache for core in structure.cores for cache in core.caches)):
        cpu.add("memories", _cache(cache, clock, context))
    for interconnect in (each for each in structure.interconnects if each.name in buses):
        cpu.add("interconnects", _interconnect(interconnect, clock, context))
    return cpu


def _core(core: perf.Core, fastest: Fraction | None, context: Exporting) -> ProjectObject:
    own = context.system.frequency_of(core.clock)
    made = ProjectObject(
        "CpuCore",
        name=core.name,
        bitWidth=ProjectObject("DataSize", value=_BITS, unit="bit"),
        prescaler=float(fastest / own) if fastest and own else 1.0,
        initiator=ProjectObject("memory.InitiatorPort", name=f"from_{core.name}"),
    )
    return context.register("CpuCore", core.name, made)


def _module(kind: str, module: Any, clock: ProjectObject | None, context: Exporting, **features: Any) -> ProjectObject:
    own = context.find("Clock", module.clock)
    if own is None:
        context.changed(module, "a memory, cache or interconnect without a clock", "with the clock of its processor")
    return context.register(kind, module.name, ProjectObject(kind, name=module.name, clock=own or clock, **features))


def _memory(memory: perf.Memory, clock: ProjectObject | None, context: Exporting) -> ProjectObject:
    return _module(
        "memory.Memory",
        memory,
        clock,
        context,
        bitWidth=ProjectObject("DataSize", value=_BITS, unit="bit"),
        size=context.size(memory.size, memory.name),
        responder=ProjectObject("memory.ResponderPort", name=_RESPONDER),
    )


def _cache(cache: perf.Cache, clock: ProjectObject | None, context: Exporting) -> ProjectObject:
    return _module("memory.CacheMemory", cache, clock, context, size=context.size(cache.size, cache.name))


_SCHEDULING = {
    perf.Arbitration.PRIORITY: "Priority",
    perf.Arbitration.ROUND_ROBIN: "RoundRobin",
    perf.Arbitration.FIRST_COME: "FCFS",
}


def _interconnect(item: perf.Interconnect, clock: ProjectObject | None, context: Exporting) -> ProjectObject:
    policy = _SCHEDULING[item.arbitration] if item.arbitration else None
    return _module("memory.Interconnect", item, clock, context, schedulingPolicy=policy)


def connect_hardware(context: Exporting) -> None:
    """Connect cores, caches and memories by interconnects, as the importer does for models without any of their own (relax.cpp)."""
    cpus, memories = context.model["cpus"], context.model["memories"]
    several = len(cpus) + len(memories) > 1
    upwards = [
        (cpu, _local_interconnect(cpu, several)) for cpu in cpus if several or len(cpu["cores"]) + len(cpu["memories"]) > 1
    ]
    if several:
        top = ProjectObject(
            "memory.Interconnect",
            name="Interconnect",
            bitWidth=ProjectObject("DataSize", value=_WIDE_BITS, unit="bit"),
            clock=context.find("IdealClock", ""),
        )
        context.model.add("interconnects", top)
        for cpu, port in upwards:
            _join(port, top.add("responders", ProjectObject("memory.ResponderPort", name=f"to_{cpu.name}")))
        for memory in memories:
            port = top.add("initiators", ProjectObject("memory.InitiatorPort", name=f"to_{memory.name}"))
            _join(port, memory["responder"])


def _local_interconnect(cpu: ProjectObject, several: bool) -> ProjectObject | None:
    """Make the interconnect of a processor; returns the port to the other processors, which is that of the last cache, if any."""
    width = cpu["cores"][0]["bitWidth"]
    made = ProjectObject(
        "memory.Interconnect",
        name=f"{cpu.name}_Interconnect",
        bitWidth=ProjectObject("DataSize", value=width["value"], unit=width["unit"]),
        clock=cpu["clock"],
    )
    cpu.add("interconnects", made)
    for core in cpu["cores"]:
        _join(core["initiator"], made.add("responders", ProjectObject("memory.ResponderPort", name=f"to_{core.name}")))
    upwards = None
    for memory in cpu["memories"]:
        if memory["responder"] is None:
            memory["responder"] = ProjectObject("memory.ResponderPort", name="to_CpuInterconnect")
        if memory.kind == "memory.CacheMemory":
            upwards = memory["initiator"] or ProjectObject("memory.InitiatorPort", name="to_SystemInterconnect")
            memory["initiator"] = upwards
        port = made.add("initiators", ProjectObject("memory.InitiatorPort", name=f"to_{memory.name}"))
        _join(port, memory["responder"])
    if several:
        upwards = upwards or made.add("initiators", ProjectObject("memory.InitiatorPort"))
        upwards["name"] = f"from_{cpu.name}"
    if not made["initiators"]:
        made.add("initiators", ProjectObject("memory.InitiatorPort", name="InitiatorPort"))
    return upwards


def _join(initiator: ProjectObject | None, responder: ProjectObject) -> None:
    if initiator is not None:
        initiator["responder"] = responder


def leave_out_memories(model: ProjectObject) -> None:
    """Remove memories, caches, interconnects and ports, as the importer of INCHRON does if asked to."""
    for item in list(model.walk()):
        for feature in {
            "Model": ("memories", "interconnects"),
            "Cpu": ("memories", "interconnects"),
            "CpuCore": ("initiator",),
            "memory.DataObject": ("memory",),
        }.get(item.kind, ()):
            item.values.pop(feature, None)
