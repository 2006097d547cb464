"""Which cores share a clock."""

from __future__ import annotations

from amalthea_uros.perf.hardware import StructureKind
from amalthea_uros.perf.system import System


def controller_of_core(system: System) -> dict[str, str]:
    """The controller of each core; cores of different controllers do not share a clock."""
    found: dict[str, str] = {}
    for structure in system.hardware.walk():
        if structure.kind is StructureKind.ECU:
            for inner in structure.walk():
                found.update(dict.fromkeys((core.name for core in inner.cores), structure.name))
    return found
