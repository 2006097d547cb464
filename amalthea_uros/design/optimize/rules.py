"""The rules of the middleware and of the hardware that designs must keep, whatever they improve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.activities import called_runnables
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import counters, known_releases, nominal_period
from amalthea_uros.units import DataSize, Time, time_text
from amalthea_uros.uros.assemble import Assembly


@dataclass(frozen=True, slots=True, kw_only=True)
class PeriodRule:
    """The period of a process must not be longer than a time, or than those of other processes.

    Attributes
    ----------
    text : what is wrong with a design that breaks it; also of other rules
    """

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


Rule: TypeAlias = PeriodRule | CapacityRule


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


def rules(assembly: Assembly | None, system: System) -> Iterator[Rule]:
    """The rules for the designs of a system.

    Parameters
    ----------
    assembly : of the description of the system; None if it has none
    """
    yield from _capacities(system)
    if assembly is not None and assembly.choices:
        yield from _periods(assembly, system)


def _capacities(system: System) -> Iterator[Rule]:
    """The sizes of the memories, as far as their content is known, and fits now."""
    for name, memory in system.memories.items():
        content = data_in(name, system)
        if memory.size is not None and content is not None and content <= memory.size:
            yield CapacityRule(memory=name, size=memory.size, text=f"{name} is too small for its data")


def _periods(assembly: Assembly, system: System) -> Iterator[Rule]:
    """The rules of the middleware for periods; see `uros.periods`."""
    served: dict[str, list[str]] = {}
    for choice in assembly.choices:
        if choice.task != choice.executor and choice.task in system.processes:
            served.setdefault(choice.executor, []).append(choice.task)
    for executor, names in served.items():
        if any(choice.task == executor for choice in assembly.choices):
            text = f"{executor} runs less often than the fastest callback"
            yield PeriodRule(process=executor, others=tuple(names), text=text)
    callbacks = [name for names in served.values() for name in names]
    intervals = _message_intervals(system)
    for name in callbacks:
        if (interval := intervals.get(name)) is not None:
            text = f"{name} runs less often than messages arrive, every {time_text(interval)}"
            yield PeriodRule(process=name, longest=interval, text=text)


def _message_intervals(system: System) -> Mapping[str, Time]:
    """How often the messages arrive that processes handle."""
    found: dict[str, Time] = {}
    for taker, counter in counters(system):
        interval = nominal_period(system.processes[taker], counter, system)
        if counter.source and interval is not None:
            for name, process in system.processes.items():
                if name == counter.source or counter.source in called_runnables(process.activities):
                    found[name] = min(interval, found.get(name, interval))
    return found
