"""The hardware of a project."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.values import frequency_of, size_of, time_of
from amalthea_uros.perf import hardware as perf
from amalthea_uros.units import SECOND, Frequency

HARDWARE = "hardware"

_LOADS = ("hypervisor", "peripherals")


def extract_hardware(context: Importing, model: ProjectObject) -> perf.Hardware:
    """Clocks, and each processor as a structure with its cores and memories."""
    structures = tuple(_structure(cpu, context) for cpu in model["cpus"])
    memories = tuple(_memory(memory, context) for memory in model["memories"])
    if memories:
        structures += (perf.Structure(name=context.name("Structure", model, "memories"), memories=memories),)
    used = {core.clock for structure in structures for core in structure.cores} | {
        memory.clock for structure in structures for memory in structure.memories
    }
    clocks = [_clock(clock, context) for clock in model["clocks"] if clock["period"] is None or clock.name in used]
    clocks += [perf.Clock(name=name, frequency=frequency) for name, frequency in context.derived_clocks.items()]
    result = perf.Hardware(clocks=tuple(clocks), structures=structures)
    return context.whole(model, HARDWARE, (perf.Hardware,)) or result


def clock_frequency(clock: ProjectObject | None) -> Frequency | None:
    """The frequency of a clock; None if it is not stated."""
    if clock is None:
        return None
    if clock["frequency"] is not None:
        return frequency_of(clock["frequency"])
    period = time_of(clock["period"])
    return Fraction(SECOND, period) if period else None


def core_frequency(core: ProjectObject) -> Frequency | None:
    """The frequency of a core: that of its processor, divided by its prescaler."""
    whole = clock_frequency(core.owner["clock"]) if core.owner is not None else None
    prescaler = Fraction(repr(float(core["prescaler"]))) if core["prescaler"] > 0 else None
    return None if whole is None or prescaler is None else whole / prescaler


def _clock(clock: ProjectObject, context: Importing) -> perf.Clock:
    if clock["drift"] or clock["startTimeIsRandom"]:
        context.leave_out(clock, "the drift or random start of a clock")
    return perf.Clock(name=clock.name, frequency=clock_frequency(clock), origin=context.located(clock))  # type: ignore[arg-type]


def loads_of_processors(model: ProjectObject) -> list[ProjectObject]:
    """Hypervisors and peripherals, which may take time of the cores of their processor, and are not understood."""
    return [part for cpu in model["cpus"] for feature, part in cpu.parts() if feature.name in _LOADS]


def cores_beside(item: ProjectObject) -> list[ProjectObject] | None:
    """The cores of the processor that an object belongs to; None if it belongs to none."""
    cpu = item.owner if item.owner is not None and item.owner.kind == "Cpu" else None
    return None if cpu is None else [*cpu["cores"], *(item["virtualCores"] if item.kind == "HyperVisorConfig" else ())]


def _structure(cpu: ProjectObject, context: Importing) -> perf.Structure:
    memories = [memory for memory in cpu["memories"] if memory.kind == "memory.Memory"]
    for feature in (*_LOADS, "partitions", "memoryRegions"):
        if cpu[feature]:
            context.leave_out(cpu, f"Cpu.{feature}")
    return perf.Structure(
        name=context.name("Structure", cpu),
        cores=tuple(_core(core, context) for core in cpu["cores"]),
        memories=tuple(_memory(memory, context) for memory in memories),
        origin=context.located(cpu),  # type: ignore[arg-type]
    )


def _core(core: ProjectObject, context: Importing) -> perf.Core:
    clock, own = core.owner["clock"] if core.owner is not None else None, core_frequency(core)
    name = clock.name if clock is not None else None
    if clock is not None and core["prescaler"] != 1.0:
        same = [each.name for each in context.model["clocks"] if clock_frequency(each) == own and each["frequency"] is not None]
        name = same[0] if same else f"{clock.name}_by_{core['prescaler']:g}"
        if not same:
            context.derived_clocks[name] = own
    return perf.Core(name=context.name("CpuCore", core), clock=name, origin=context.located(core))  # type: ignore[arg-type]


def _memory(memory: ProjectObject, context: Importing) -> perf.Memory:
    return perf.Memory(
        name=context.name("Memory", memory),
        clock=memory["clock"].name if memory["clock"] is not None else None,
        size=size_of(memory["size"]),
        origin=context.located(memory),  # type: ignore[arg-type]
    )
