"""The hardware section of a description as the hardware of a system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from amalthea_uros._internal.records import dataclass
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
from amalthea_uros.uros.application.notes import Notes


@dataclass(frozen=True, slots=True, kw_only=True)
class Controller:
    """The hardware, and its properties that the software depends on.

    Attributes
    ----------
    platform : the name that execution times use for it; None if it is described inline
    frequencies : by core, in the order of the cores
    core_types : by core
    label_memory : of labels without a memory of their own
    """

    hardware: Hardware
    platform: str | None
    frequencies: Mapping[str, Frequency]
    core_types: Mapping[str, str]
    memories: tuple[str, ...]
    label_memory: str | None

    @property
    def first_core(self) -> str:
        """The default core."""
        return next(iter(self.frequencies))


def controller_of(name: str, section: spec.HardwareSection, platform: str | None, notes: Notes) -> Controller | None:
    """The controller; None, with findings, if its description is invalid.

    Parameters
    ----------
    name : of the application, which becomes the name of the system
    section : the hardware, completed by its platform
    """
    cores = section.cores or [spec.CoreSection(name="Core_0")]
    frequencies: dict[str, Frequency] = {}
    for core in cores:
        frequency = core.frequency or section.frequency
        if frequency is None:
            advice = "Set a frequency, e.g. 'frequency: 300 MHz', or name a platform."
            if platform is not None:
                advice = (
                    f"The platform {platform!r} does not know its clock: set it under 'hardware', e.g. 'frequency: 300 MHz'."
                )
            notes.error("APP005", f"the frequency of core {core.name!r} is unknown", _origin(core, section), advice)
        elif core.name in frequencies:
            first = next(other for other in cores if other.name == core.name)
            notes.duplicate("core", core.name, _origin(core, section), _origin(first, section))
        else:
            frequencies[core.name] = frequency
    memories = section.memories or []
    for memory in memories:
        first_memory = next(other for other in memories if other.name == memory.name)
        if memory is not first_memory:
            notes.duplicate("memory", memory.name, memory.location("name"), first_memory.location("name"))
    _check_accesses(memories, frequencies, notes)
    label_memory = _label_memory(section, notes)
    if notes.has_errors:
        return None
    default_type = section.core_type or "Core"
    return Controller(
        hardware=_hardware(name, section, cores, frequencies, default_type),
        platform=platform,
        frequencies=frequencies,
        core_types={core.name: core.type or default_type for core in cores},
        memories=tuple(memory.name for memory in memories),
        label_memory=label_memory,
    )


def _origin(core: spec.CoreSection, section: spec.HardwareSection) -> Location | None:
    return core.location() or section.location()


def _label_memory(section: spec.HardwareSection, notes: Notes) -> str | None:
    names = [memory.name for memory in section.memories or ()]
    if section.label_memory is not None:
        if section.label_memory not in names:
            notes.undefined("memory", section.label_memory, names, section.location("label_memory"))
        return section.label_memory
    return next((memory.name for memory in section.memories or () if memory.kind in ("SRAM", "DRAM")), None)


def _hardware(
    name: str,
    section: spec.HardwareSection,
    cores: list[spec.CoreSection],
    frequencies: Mapping[str, Frequency],
    default_type: str,
) -> Hardware:
    clocks = _clocks(frequencies)
    types = dict.fromkeys(core.type or default_type for core in cores)
    microcontroller = Structure(
        name=section.microcontroller or "Controller",
        kind=StructureKind.MICROCONTROLLER,
        cores=tuple(
            Core(
                name=core.name,
                type=core.type or default_type,
                clock=clocks[frequencies[core.name]].name,
                accesses=tuple(_accesses(core.name, section.memories or ())),
                origin=_origin(core, section),
            )
            for core in cores
        ),
        memories=tuple(_memory(memory) for memory in section.memories or ()),
        origin=section.location(),
    )
    inner = microcontroller
    if section.title is not None:
        inner = Structure(name=section.title, kind=StructureKind.ECU, structures=(microcontroller,), origin=section.location())
    return Hardware(
        clocks=tuple(clocks.values()),
        core_types=tuple(CoreType(name=name, kind=CoreKind.CPU, origin=section.location()) for name in types),
        structures=(Structure(name=name, kind=StructureKind.SYSTEM, structures=(inner,), origin=section.location()),),
    )


def _clocks(frequencies: Mapping[str, Frequency]) -> dict[Frequency, Clock]:
    """A clock for each frequency."""
    different = dict.fromkeys(frequencies.values())
    if len(different) == 1:
        return {frequency: Clock(name="Clock", frequency=frequency) for frequency in different}
    return {f: Clock(name=f"Clock_{frequency_text(f).replace(' ', '_')}", frequency=f) for f in different}


def _memory(memory: spec.MemorySection) -> Memory:
    kinds = {"flash": MemoryKind.FLASH, "SRAM": MemoryKind.SRAM, "DRAM": MemoryKind.DRAM, "PCM": MemoryKind.PCM}
    kind = kinds[memory.kind] if memory.kind else None
    return Memory(name=memory.name, size=memory.size, kind=kind, origin=memory.location())


def _accesses(core: str, memories: Iterable[spec.MemorySection]) -> Iterator[Access]:
    """What it costs a core to access the memories of which that is known."""
    for memory in memories:
        cycles = _cycles(core, memory)
        if cycles != (None, None):
            read, write = (None if number is None else Constant(number) for number in cycles)
            yield Access(memory=memory.name, latency=Latency(read=read, write=write))


def _cycles(core: str, memory: spec.MemorySection) -> tuple[int | None, int | None]:
    """Cycles of a read and of a write: those of the core, else those of all cores."""
    for own in memory.accesses:
        if core in own.cores:
            return own.read_cycles, own.write_cycles
    return memory.read_cycles, memory.write_cycles


def _check_accesses(memories: Iterable[spec.MemorySection], cores: Mapping[str, Frequency], notes: Notes) -> None:
    """Report undefined cores, and those for which a memory states two costs."""
    for memory in memories:
        seen: set[str] = set()
        for latencies in memory.accesses:
            for index, core in enumerate(latencies.cores):
                location = latencies.location("cores", index)
                if core not in cores:
                    notes.undefined("core", core, cores, location)
                elif core in seen:
                    message = f"the memory {memory.name!r} states twice what accesses from {core!r} cost"
                    notes.error("APP003", message, location, "Remove one of them.")
                seen.add(core)
