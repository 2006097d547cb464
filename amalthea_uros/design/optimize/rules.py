"""The rules that designs must keep, whatever they improve."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.units import DataSize, Time


class Rule(Protocol):
    """A rule; the text says what is wrong with a design that breaks it."""

    @property
    def text(self) -> str:
        """What is wrong."""

    def is_broken(self, system: System) -> bool:
        """Whether a system breaks it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PeriodRule:
    """The period of a process must not be longer than a time, or than those of other processes."""

    process: str
    longest: Time | None = None
    others: tuple[str, ...] = ()
    text: str

    def is_broken(self, system: System) -> bool:
        """Whether a system breaks it; unknown periods do not."""
        period = period_of(self.process, system)
        limits = [self.longest, *(period_of(other, system) for other in self.others)]
        return period is not None and any(limit is not None and period > limit for limit in limits)


@dataclass(frozen=True, slots=True, kw_only=True)
class CapacityRule:
    """The data in a memory must not be larger than the memory.

    Attributes
    ----------
    size : of the memory
    """

    memory: str
    size: DataSize
    text: str

    def is_broken(self, system: System) -> bool:
        """Whether a system breaks it, or data of unknown size are in the memory."""
        content = data_in(self.memory, system)
        return content is None or content > self.size


def data_in(memory: str, system: System) -> DataSize | None:
    """The size of all that is mapped to a memory; None if that of something is unknown."""
    total = 0
    for element, place in system.memory_of.items():
        if place == memory:
            size = size_of(element, system)
            if size is None:
                return None
            total += size
    return total


def size_of(element: str, system: System) -> DataSize | None:
    """The size of a label or channel; None if it is unknown."""
    if element in system.labels:
        return system.labels[element].size
    channel = system.channels.get(element)
    if channel is None or channel.element_size is None or not channel.capacity:
        return None
    return channel.element_size * channel.capacity


def period_of(process: str, system: System) -> Time | None:
    """The period of a process; None if it is unknown, or there is no such process."""
    found = known_releases(system.processes[process], system) if process in system.processes else None
    return None if found is None else found.period
