"""What is analysed instead of, or beyond, what the system says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction

from amalthea_uros.perf.software import Communication
from amalthea_uros.units import Frequency


class Memory(StrEnum):
    """What accesses to labels cost: nothing, each one its latency, or a copy of each label at the start and the end of a job."""

    NONE = "none"
    EXPLICIT = "explicit"
    IMPLICIT = "implicit"


@dataclass(frozen=True, slots=True)
class Settings:
    """Of an analysis.

    Attributes
    ----------
    frequencies : of cores, instead of what the system says
    scale : factor on all execution times, as if clocks were slower by it
    factors : the same for single processes
    modes : values of mode labels that do not change
    communication : how all labels are read and written; None: as the model says, and implicit where it says nothing
    all_phases : whether counters at which chains start may start at any of their occurrences
    """

    frequencies: Mapping[str, Frequency] = field(default_factory=dict)
    scale: Fraction = Fraction(1)
    factors: Mapping[str, Fraction] = field(default_factory=dict)
    modes: Mapping[str, str] = field(default_factory=dict)
    memory: Memory = Memory.NONE
    communication: Communication | None = None
    all_phases: bool = False

    def __post_init__(self) -> None:
        for name, kind in (("memory", Memory), ("communication", Communication)):
            given = getattr(self, name)
            if given is not None and not isinstance(given, kind):
                members = ", ".join(f"{kind.__name__}.{member.name}" for member in kind)
                raise TypeError(f"unknown {name} {given!r}; expected one of {members}")
