"""What two systems have in common: the values of their objects, without the names that a description does not state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TypeAlias

from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Counter
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.phases import counters, first_time, nominal_period, with_counters
from amalthea_uros.timing.scheduling.allocation import allocated_cores, frequency_of
from amalthea_uros.units import Time

#: An object and what is compared of it -> the value.
Meaning: TypeAlias = Mapping[tuple[str, str], object]


def meaning(system: System) -> Meaning:
    """The values of a system that decide about its behaviour.

    Stimuli and clocks count by their values, messages by the time between them; of priorities, the order counts.
    """
    return dict(_values(system))


def _values(system: System) -> Iterator[tuple[tuple[str, str], object]]:
    cores = allocated_cores(system)
    system = with_counters(system, lambda process, counter: _by_time(process, counter, system))
    for name, process in system.processes.items():
        stimuli = [system.stimuli_by_name[stimulus] for stimulus in process.stimuli if stimulus in system.stimuli_by_name]
        yield (name, "period"), [replace(stimulus, name="") for stimulus in stimuli]
        yield (name, "core"), cores.get(name)
        yield (name, "activities"), replace(process, stimuli=())
    for allocation in system.mapping.tasks:
        yield (allocation.task, "deadline"), allocation.deadline
    for isr in system.mapping.isrs:
        yield (isr.isr, "priority"), isr.priority
    for core in system.cores:
        yield (core, "order of priorities"), _order(core, system, cores)
        yield (core, "frequency"), frequency_of(system.cores[core].clock, system)
    for name, runnable in system.runnables.items():
        yield (name, "execution_time"), runnable
    yield ("the system", "labels"), (system.software.labels, system.software.channels, system.mapping.placements)
    yield ("the system", "chains"), system.events.chains
    yield ("the system", "requirements"), system.constraints


def _by_time(process: Process, counter: Counter, system: System) -> Counter:
    """A counter of what comes from outside, by time instead of the number of jobs."""
    interval = nominal_period(process, counter, system)
    if not counter.source or interval is None:
        return counter
    first = first_time(process.name, counter, system) if counter.is_phase_known else 0
    jitter = counter.arrivals.jitter if counter.arrivals else 0
    return replace(counter, prescaler=interval, offset=first or 0, arrivals=Arrivals(jitter=jitter))


def _order(core: str, system: System, cores: Mapping[str, frozenset[str]]) -> list[list[str]]:
    """The tasks of a core by falling priority; those of the same priority together."""
    levels: dict[int | None, list[str]] = {}
    for allocation in system.mapping.tasks:
        if core in cores.get(allocation.task, ()):
            levels.setdefault(allocation.priority, []).append(allocation.task)
    return [sorted(levels[level]) for level in sorted(levels, key=lambda level: -1 if level is None else level, reverse=True)]


def differences(one: Meaning, other: Meaning) -> list[tuple[str, str]]:
    """The objects of which something differs, and what."""
    return [key for key in dict.fromkeys([*one, *other]) if one.get(key) != other.get(key)]


def arrival_periods(system: System) -> Mapping[str, Time]:
    """The nominal time between two of what comes from outside."""
    found = ((counter.source, nominal_period(system.processes[name], counter, system)) for name, counter in counters(system))
    return {source: period for source, period in found if source and period is not None}
