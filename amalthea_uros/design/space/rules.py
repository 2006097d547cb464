"""The rules of the middleware and of the hardware that designs must keep."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.design.optimize.rules import CapacityRule, PeriodRule, Rule, data_in
from amalthea_uros.perf.activities import Call, walk
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.phases import counters, nominal_period
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.assemble import Assembly


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
                if name == counter.source or counter.source in _runnables(process):
                    found[name] = min(interval, found.get(name, interval))
    return found


def _runnables(process: Process) -> set[str]:
    return {activity.runnable for activity in walk(process.activities) if isinstance(activity, Call)}
