"""What two systems have in common: the values of their objects, without the names that a description does not state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TypeAlias

from amalthea_uros._internal.paths import TEXT
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.changed_model import changed_system
from amalthea_uros.design.description.assign import Assignment, apply_assignments
from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.design.description.texts import edited_assembly
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Counter, Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import counters, first_time, nominal_period, with_counters
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.described import describe_text

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
        yield (core, "frequency"), system.frequency_of(system.cores[core].clock)
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


@dataclass(frozen=True, slots=True, kw_only=True)
class EditedDescription:
    """A description with other values.

    Attributes
    ----------
    text : with them
    assignments : what was written for the changes
    kept : what was written to keep values as they were, which would otherwise have followed the others
    """

    text: str
    assignments: tuple[Assignment, ...]
    kept: tuple[Assignment, ...]


@dataclass(frozen=True)
class DescriptionEditor:
    """Edits the text of a description.

    Attributes
    ----------
    text : with the line ends of the file
    path : the file of the text, for findings, and for the files that it names
    """

    text: str
    path: Path = TEXT

    @cached_property
    def _built(self) -> BuiltObjects:
        return BuiltObjects(describe_text(self.text, self.path), self.text)

    def edited(self, changes: Sequence[Change]) -> EditedDescription:
        """The text with changes.

        The edited text is read again, and must describe the system that the changes make of the present one. Where values that the
        description leaves open would follow the changes, such as priorities by rate, they are written, too.

        Raises
        ------
        ReadError : something in the text is wrong.
        InvalidArgumentError : a change cannot be stated in a description, or would have other effects than stated.
        """
        before = self._built.values.assembly.system
        expected = changed_system(before, changes, Settings())
        assignments = [assignment for change in changes for assignment in self._built.assignments(change)]
        consequences: list[Assignment] = []
        while True:
            edited = apply_assignments(self.text, [*assignments, *consequences])
            found = edited_assembly(edited, self.path, changes).system
            pinned = {assignment.target for assignment in (*assignments, *consequences)}
            different = differences(meaning(expected), meaning(found))
            if not different:
                break
            more = [change for change in _pins(different, expected, found) if change.target not in pinned]
            if not more:
                raise InvalidArgumentError(_other_effect(changes, different, before, expected))
            consequences += [assignment for change in more for assignment in self._built.assignments(change)]
        return EditedDescription(text=edited, assignments=tuple(assignments), kept=tuple(consequences))


def _pins(different: Iterable[tuple[str, str]], expected: System, found: System) -> Iterable[Change]:
    """The changes that make what follows by default as it is to be: priorities by rate, and periods on offer."""
    for name, what in different:
        if what == "order of priorities":
            priorities = {each.task: each.priority for each in found.mapping.tasks}
            for each in expected.mapping.tasks:
                if each.priority is not None and each.priority != priorities.get(each.task):
                    yield Change(each.task, "priority", str(each.priority))
        elif what == "period":
            match [expected.stimuli_by_name[stimulus] for stimulus in expected.processes[name].stimuli]:
                case [Periodic(period=period)]:
                    yield Change(name, "period", time_text(period))


def _other_effect(changes: Sequence[Change], different: Sequence[tuple[str, str]], before: System, expected: System) -> str:
    what, after = ", ".join(map(str, changes)), arrival_periods(expected)
    for source, period in arrival_periods(before).items():
        if after.get(source, period) != period:
            same = Change(source, "arrival_period", time_text(period))
            return (
                f"{what} also changes the time between two messages of {source!r} from {time_text(period)} to "
                f"{time_text(after[source])}; add {same} to keep it, or the new value"
            )
    others = ", ".join(f"the {key.replace('_', ' ')} of {name}" for name, key in different[:5])
    return f"an app.yaml cannot state {what}: {others} would differ from what the change makes of the system"
