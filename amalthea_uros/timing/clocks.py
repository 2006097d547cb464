"""The frequencies of clocks, and which cores share one."""

from __future__ import annotations

from amalthea_uros.perf.hardware import StructureKind
from amalthea_uros.perf.system import System
from amalthea_uros.units import Frequency


def frequency_of(clock: str | None, system: System) -> Frequency | None:
    """The frequency of a clock; None if it is unknown, and what a frequency that is not positive stands for is unknown, too."""
    found = system.clocks.get(clock or "")
    return found.frequency if found is not None and found.frequency is not None and found.frequency > 0 else None


def controller_of_core(system: System) -> dict[str, str]:
    """The controller of each core; cores of different controllers do not share a clock."""
    found: dict[str, str] = {}
    for structure in system.hardware.walk():
        if structure.kind is StructureKind.ECU:
            for inner in structure.walk():
                found.update(dict.fromkeys((core.name for core in inner.cores), structure.name))
    return found
