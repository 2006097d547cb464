"""Which combinations of phases give the same results, so that one of them is enough.

Time is divided into slots of equal length. If all jobs that are released in a slot also end in it, whatever their phases, the slots do
not affect each other, and the schedule is a row of slots that repeats from the start, without a transient. What happens to a process
then follows from the slots in which it is released: from the jobs of at least its priority in them, and from what these execute.
Two combinations of phases with the same row of slots, except for where in the cycle it begins, are schedules that are shifted by
some slots: the jobs of a process have the same times relative to their releases, in the same cyclic order. Where the row begins has
no effect, because all evaluations cover whole cycles.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from functools import cache, cached_property
from math import gcd, lcm
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.perf.activities import Call, Trigger, walk
from amalthea_uros.perf.constraints import LatencyConstraint
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess, Periodic
from amalthea_uros.timing.activation.releases import (
    ExternalInput,
    known_releases,
    own_counters,
    phase_combinations,
    phase_count,
    with_phases,
)
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.jobs.counters import first_effect, reached
from amalthea_uros.timing.jobs.positions import MAX_POSITIONS
from amalthea_uros.units import Time

#: The number of the first combination of each case, and how many combinations the case has.
Cases: TypeAlias = Mapping[int, int]
#: With more combinations of phases, or more work of all that are solved, any job can be the one that takes what comes from outside.
MAX_COMBINATIONS = 1000
MAX_JOBS = 400_000
#: A solution, with what is evaluated of it, takes as long for a process or a chain as for so many jobs, and for an activity as for one.
_JOBS_PER_PROCESS, _JOBS_PER_CHAIN = 100, 50


def work_of(solution: Solution, chains: int) -> int:
    """The work of a solution and of what is evaluated of it, in jobs.

    Parameters
    ----------
    chains : number of those that are evaluated
    """
    processes, sizes = solution.context.system.processes.values(), solution.context.dataflow.events.sites.sizes
    activities = (reached(process.activities, sizes) for process in processes)
    # Of processes with more activities, these are not followed one by one.
    followed = sum(each for each in activities if each <= MAX_POSITIONS)
    return _work_of_processes(solution) + chains * _JOBS_PER_CHAIN + followed


def _work_of_processes(solution: Solution) -> int:
    """The work of a solution, in jobs: also processes without response times are looked through."""
    return solution.jobs + len(solution.context.system.processes) * _JOBS_PER_PROCESS


@dataclass(frozen=True)
class PhaseCases:
    """The combinations of the phases of what comes from outside, each of which makes a solution of its own, and their cases.

    Attributes
    ----------
    solution : for unknown phases; its response times bound those for all of them
    first : for the first combination
    combinations : the first job that takes each occurrence
    """

    solution: Solution
    first: Solution
    combinations: Sequence[Mapping[ExternalInput, int]]

    @classmethod
    def of(cls, solution: Solution, unknown: Sequence[ExternalInput]) -> PhaseCases | None:
        """The combinations of some unknown phases; None if there are none or too many."""
        count = phase_count(unknown)
        if not unknown or count > MAX_COMBINATIONS:
            return None
        combinations = list(phase_combinations(unknown))
        first = _solution(solution.context, combinations[0])
        # All of them are compared, process by process, before it is known how many of them are solved.
        if count * _work_of_processes(first) > MAX_JOBS:
            return None
        return cls(solution, first, combinations)

    def solutions(self, cases: Cases) -> Iterator[tuple[int, Solution]]:
        """The numbers of the combinations of some cases, and their solutions."""
        for number in cases:
            yield number, self._solution(number) if number else self.first

    def _solution(self, number: int) -> Solution:
        return _solution(self.solution.context, self.combinations[number], self.first.context)

    def of_everything(self) -> Cases:
        """The cases of a whole system: combinations of one case can differ in no result."""
        constraints = self.first.context.system.constraints
        if constraints.data_ages or not all(isinstance(each, LatencyConstraint) for each in constraints.constraints):
            return self._single
        first = {number for cases in (*self.of_processes.values(), *self.of_chains) for number in cases}
        return dict.fromkeys(sorted(first), 1)

    @cached_property
    def of_processes(self) -> Mapping[str, Cases]:
        """The cases of the jobs of each process, and of the callbacks in them."""
        return {name: self._of_process(name) for name in self.first.context.system.processes}

    @cached_property
    def of_chains(self) -> Sequence[Cases]:
        """The cases of the latencies of each chain."""
        return [self.of_chain(chain) for chain in self.first.context.system.events.chains]

    def _of_process(self, name: str) -> Cases:
        if self._is_untouched(name):
            return self._same
        slots = self._slots([name])
        return self._single if slots is None else self._by_key(slots.rows(name))

    def of_chain(self, chain: EventChain) -> Cases:
        """The cases of the latencies of a chain."""
        passed = list(dict.fromkeys(stage.process.name for stage in self._evaluation.stages(chain)))
        if all(map(self._is_untouched, passed)):
            return self._same
        slots = self._slots(passed)
        if slots is None:
            return self._single
        return self._by_key(slots.rows())

    @cached_property
    def _evaluation(self) -> ChainEvaluator:
        return ChainEvaluator(self.solution)

    @property
    def _same(self) -> Cases:
        """All combinations are one case."""
        return {0: len(self.combinations)}

    @property
    def _single(self) -> Cases:
        """Each combination is a case of its own."""
        return dict.fromkeys(range(len(self.combinations)), 1)

    def _by_key(self, keys: Sequence[Hashable]) -> Cases:
        first: dict[Hashable, int] = {}
        found: dict[int, int] = {}
        for number, key in enumerate(keys):
            of_case = first.setdefault(key, number)
            found[of_case] = found.get(of_case, 0) + 1
        return found

    def _is_untouched(self, name: str) -> bool:
        """Whether no phase can have an effect on a process."""
        context = self.first.context
        scheduled = context.scheduled.get(name)
        return scheduled is None or scheduled.core not in self._touched_cores

    @cached_property
    def _touched_cores(self) -> frozenset[str]:
        """The cores on which something takes an occurrence, or depends on other processes."""
        context = self.first.context
        if context.system.os.semaphores:
            return frozenset(context.system.cores)
        taking = {occurrence.process for occurrence in self.combinations[0]}
        return frozenset(item.core for name, item in context.scheduled.items() if name in taking or self._is_triggered(name))

    def _is_triggered(self, name: str) -> bool:
        system = self.first.context.system
        stimuli = [system.stimuli_by_name.get(stimulus) for stimulus in system.processes[name].stimuli]
        return any(isinstance(stimulus, InterProcess | EventTriggered) for stimulus in stimuli)

    @cached_property
    def _has_inner_counters(self) -> bool:
        """Whether runnables count what they do, so that the counters of a process do not say all about its jobs."""
        return any(
            isinstance(activity, Call | Trigger) and activity.counter is not None
            for runnable in self.first.context.system.software.runnables
            for activity in walk(runnable.activities)
        )

    def _slots(self, names: Sequence[str]) -> _Slots | None:
        """The slots of some processes and all that precede them; None if slots affect each other, or if that is unknown."""
        context = self.first.context
        places = [context.scheduled.get(name) for name in names]
        tasks: dict[str, _SlotTask] = {}
        for place in places:
            if place is None or not self._is_exact(place.core):
                return None
            for scheduled in context.on_core(place.core):
                if scheduled.rank >= place.rank:
                    task = self._task(scheduled.name)
                    if task is None:
                        return None
                    tasks[scheduled.name] = task
        periods = [task.releases.period for task in tasks.values()]
        lengths = sorted({gcd(*periods), *periods, lcm(*periods)})
        length = next((length for length in lengths if all(task.ends_in_slots(length) for task in tasks.values())), None)
        if length is None:
            return None
        key = frozenset(tasks)
        if key not in self._made_slots:
            self._made_slots[key] = _Slots(tasks, length, self.combinations)
        return self._made_slots[key]

    @cached_property
    def _made_slots(self) -> dict[frozenset[str], _Slots]:
        """The slots by their tasks: chains and processes often have the same ones."""
        return {}

    def _is_exact(self, core: str) -> bool:
        """Whether the schedule of a core is evaluated for each combination, and repeats from the start."""
        if self._has_inner_counters:
            return False
        found = self.first.schedule(core)
        if found is None:
            return False
        return found.steady_state_start - found.cycle == max(task.offset for task in found.tasks.values())

    def _task(self, name: str) -> _SlotTask | None:
        """A process; None if its jobs do not repeat from the start, or if their response times are unbounded."""
        system, response = self.solution.context.system, self.solution.responses.get(name)
        process = system.processes[name]
        releases, counters = known_releases(process, system), tuple(own_counters(process))
        if releases is None or releases.offset >= releases.period or response is None or response.worst is None:
            return None
        for counter in counters:
            if counter.is_phase_known:
                is_repeating = first_effect(counter) <= counter.prescaler
            else:
                is_repeating = ExternalInput.of(name, counter) in self.combinations[0]
            if not is_repeating:
                return None
        return _SlotTask(name, releases, response.worst, counters)


@dataclass(frozen=True, slots=True)
class _SlotTask:
    """A process with known releases, the bound of its response times for all phases, and what counts its jobs."""

    name: str
    releases: Periodic
    response: Time
    counters: Sequence[Counter]

    @property
    def cycle(self) -> Time:
        return self.releases.period * lcm(*(counter.prescaler for counter in self.counters))

    def ends_in_slots(self, length: Time) -> bool:
        """Whether each job ends in the slot in which it is released: releases are at all multiples of a step in the slots."""
        step = gcd(length, self.releases.period)
        return self.releases.offset % step + self.response <= step

    def executed(self, phases: Sequence[int], jobs: int) -> list[tuple[bool, ...]]:
        """For each of the first jobs, which of the counters let it do something."""
        if not self.counters:
            return [()] * jobs
        each = zip(phases, self.counters, strict=True)
        return list(zip(*(_selected(phase, counter.prescaler, jobs) for phase, counter in each), strict=True))

    def phases(self, combinations: Sequence[Mapping[ExternalInput, int]]) -> list[tuple[int, ...]]:
        """The first job that each counter selects, for each combination."""
        inputs = [None if each.is_phase_known else ExternalInput.of(self.name, each) for each in self.counters]
        known = [first_effect(each) for each in self.counters]
        return [
            tuple([first if key is None else combination[key] for key, first in zip(inputs, known, strict=True)])
            for combination in combinations
        ]


@cache
def _selected(phase: int, prescaler: int, jobs: int) -> tuple[bool, ...]:
    """Which of the first jobs a counter selects."""
    return tuple((job - phase) % prescaler == 0 for job in range(1, jobs + 1))


#: In the place of the number of what happens in a slot.
_NOT_COUNTED = -1


class _Slots:
    """The slots of some tasks over a cycle."""

    def __init__(
        self, tasks: Mapping[str, _SlotTask], length: Time, combinations: Sequence[Mapping[ExternalInput, int]]
    ) -> None:
        self._tasks = tasks
        self._length = length
        self._cycle = lcm(length, *(task.cycle for task in tasks.values()))
        self._releases = {name: self._slots_of(task) for name, task in tasks.items()}
        self._columns: dict[tuple[str, tuple[int, ...]], list[int]] = {}
        self._cells: dict[Hashable, int] = {}
        self._contents: dict[tuple[int, ...], int] = {}
        self._rows: dict[tuple[int, ...], tuple[int, ...]] = {}
        phases = [task.phases(combinations) for task in tasks.values()]
        self._numbered = list(map(cache(self._numbers), zip(*phases, strict=True)))

    def rows(self, name: str | None = None) -> list[tuple[int, ...]]:
        """For each combination what happens in each slot, by numbers, from the first slot on that makes the row the least one.

        Parameters
        ----------
        name : only slots in which this process is released count; None: all
        """
        if name is None:
            return list(map(self._rotated, self._numbered))
        released = {slot for slot, _ in self._releases[name]}
        if len(released) * self._length == self._cycle:
            return self.rows()
        is_counted = [slot in released for slot in range(self._cycle // self._length)]
        return [
            self._rotated(tuple([number if counts else _NOT_COUNTED for number, counts in zip(row, is_counted, strict=True)]))
            for row in self._numbered
        ]

    def _rotated(self, row: tuple[int, ...]) -> tuple[int, ...]:
        if row not in self._rows:
            start = least_rotation(row)
            self._rows[row] = row[start:] + row[:start]
        return self._rows[row]

    def _numbers(self, phases: tuple[tuple[int, ...], ...]) -> tuple[int, ...]:
        """The contents of the slots, by numbers, if the counters of the tasks select these first jobs."""
        columns = [self._column(task, own) for task, own in zip(self._tasks.values(), phases, strict=True)]
        contents = self._contents
        return tuple([contents.setdefault(jobs, len(contents)) for jobs in zip(*columns, strict=True)])

    def _slots_of(self, task: _SlotTask) -> list[tuple[int, Time]]:
        """For each job of a cycle, the slot in which it is released, and when in the slot."""
        period, offset = task.releases.period, task.releases.offset
        return [divmod(offset + job * period, self._length) for job in range(self._cycle // period)]

    def _column(self, task: _SlotTask, phases: tuple[int, ...]) -> list[int]:
        """When in each slot a task is released, and what its jobs then do, by numbers."""
        key = (task.name, phases)
        if key not in self._columns:
            releases = self._releases[task.name]
            cells: list[tuple[Hashable, ...]] = [()] * (self._cycle // self._length)
            for (slot, at), executed in zip(releases, task.executed(phases, len(releases)), strict=True):
                cells[slot] += ((at, executed),)
            self._columns[key] = [self._cells.setdefault(jobs, len(self._cells)) for jobs in cells]
        return self._columns[key]


def least_rotation(row: Sequence[int]) -> int:
    """The start of the lexicographically least rotation of a row, in linear time.

    Of two candidates, the one that is found to be greater rules out all starts up to the difference (Y. Shiloach, "Fast canonization of
    circular strings", Journal of Algorithms 2, 1981).
    """
    one, other, same = 0, 1, 0
    while max(one, other, same) < len(row):
        first, second = row[(one + same) % len(row)], row[(other + same) % len(row)]
        if first == second:
            same += 1
            continue
        if first > second:
            one += same + 1
        else:
            other += same + 1
        other += one == other
        same = 0
    return min(one, other)


def _solution(context: TimingContext, combination: Mapping[ExternalInput, int], alike: TimingContext | None = None) -> Solution:
    return solve(timing_context(with_phases(context.system, combination), context.settings, alike))
