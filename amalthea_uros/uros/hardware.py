"""The hardware model of a description as the hardware of a system."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.hardware import (
    Access,
    Clock,
    Core,
    CoreKind,
    CoreType,
    Hardware,
    Latency,
    Memory,
    MemoryKind,
    Structure,
    StructureKind,
)
from amalthea_uros.spec import hardware as spec
from amalthea_uros.units import Frequency, frequency_text
from amalthea_uros.uros.notes import Notes


@dataclass(frozen=True, slots=True, kw_only=True)
class Controller:
    """The hardware, and what the software has to know of it.

    Attributes
    ----------
    platform : name by which execution times refer to it; None if it was described inline
    frequencies : by core, in the order of the cores
    core_types : by core
    label_memory : where labels lie that do not state it
    """

    hardware: Hardware
    platform: str | None
    frequencies: Mapping[str, Frequency]
    core_types: Mapping[str, str]
    memories: tuple[str, ...]
    label_memory: str | None

    @property
    def first_core(self) -> str:
        """The core of everything that does not state one."""
        return next(iter(self.frequencies))


def controller(name: str, stated: spec.Hardware, platform: str | None, notes: Notes) -> Controller | None:
    """The controller; None, with a note, if too little is said about it.

    Parameters
    ----------
    name : of the application, which names the system
    stated : the hardware, completed by its platform
    """
    cores = stated.cores or [spec.Core(name="Core_0")]
    frequencies: dict[str, Frequency] = {}
    for core in cores:
        frequency = core.frequency or stated.frequency
        if frequency is None:
            advice = "Give 'frequency: 300 MHz' for all cores, or name a platform."
            notes.error("APP005", f"the clock of core {core.name!r} is not known", _place(core, stated), advice)
        elif core.name in frequencies:
            notes.error("APP002", f"there are two cores named {core.name!r}", _place(core, stated))
        else:
            frequencies[core.name] = frequency
    memories = stated.memories or []
    for index, memory in enumerate(memories):
        if any(memory.name == other.name for other in memories[:index]):
            notes.error("APP002", f"there are two memories named {memory.name!r}", memory.location("name"))
    label_memory = _label_memory(stated, notes)
    if notes.has_errors:
        return None
    default_type = stated.core_type or "Core"
    return Controller(
        hardware=_hardware(name, stated, cores, frequencies, default_type),
        platform=platform,
        frequencies=frequencies,
        core_types={core.name: core.type or default_type for core in cores},
        memories=tuple(memory.name for memory in memories),
        label_memory=label_memory,
    )


def _place(core: spec.Core, stated: spec.Hardware) -> Location | None:
    return core.location() or stated.location()


def _label_memory(stated: spec.Hardware, notes: Notes) -> str | None:
    names = [memory.name for memory in stated.memories or ()]
    if stated.label_memory is not None:
        if stated.label_memory not in names:
            notes.unknown("memory", stated.label_memory, names, stated.location("label_memory"))
        return stated.label_memory
    return next((memory.name for memory in stated.memories or () if memory.kind in ("SRAM", "DRAM")), None)


def _hardware(
    name: str, stated: spec.Hardware, cores: list[spec.Core], frequencies: Mapping[str, Frequency], default_type: str
) -> Hardware:
    clocks = _clocks(frequencies)
    types = dict.fromkeys(core.type or default_type for core in cores)
    accesses = tuple(access for memory in stated.memories or () for access in _accesses(memory))
    microcontroller = Structure(
        name=stated.microcontroller or "Controller",
        kind=StructureKind.MICROCONTROLLER,
        cores=tuple(
            Core(
                name=core.name,
                type=core.type or default_type,
                clock=clocks[frequencies[core.name]].name,
                accesses=accesses,
                origin=_place(core, stated),
            )
            for core in cores
        ),
        memories=tuple(_memory(memory) for memory in stated.memories or ()),
        origin=stated.location(),
    )
    inner = microcontroller
    if stated.title is not None:
        inner = Structure(name=stated.title, kind=StructureKind.ECU, structures=(microcontroller,), origin=stated.location())
    return Hardware(
        clocks=tuple(clocks.values()),
        core_types=tuple(CoreType(name=name, kind=CoreKind.CPU, origin=stated.location()) for name in types),
        structures=(Structure(name=name, kind=StructureKind.SYSTEM, structures=(inner,), origin=stated.location()),),
    )


def _clocks(frequencies: Mapping[str, Frequency]) -> dict[Frequency, Clock]:
    """A clock for each frequency."""
    different = dict.fromkeys(frequencies.values())
    if len(different) == 1:
        return {frequency: Clock(name="Clock", frequency=frequency) for frequency in different}
    return {f: Clock(name=f"Clock_{frequency_text(f).replace(' ', '_')}", frequency=f) for f in different}


def _memory(memory: spec.Memory) -> Memory:
    kinds = {"flash": MemoryKind.FLASH, "SRAM": MemoryKind.SRAM, "DRAM": MemoryKind.DRAM, "PCM": MemoryKind.PCM}
    kind = kinds[memory.kind] if memory.kind else None
    return Memory(name=memory.name, size=memory.size, kind=kind, origin=memory.location())


def _accesses(memory: spec.Memory) -> list[Access]:
    if memory.read_cycles is None and memory.write_cycles is None:
        return []
    read, write = (None if cycles is None else Constant(cycles) for cycles in (memory.read_cycles, memory.write_cycles))
    return [Access(memory=memory.name, latency=Latency(read=read, write=write))]
