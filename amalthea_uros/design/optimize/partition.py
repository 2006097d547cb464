"""Which sets of tasks fit on a core together, and how much of it they need: what a mapping of tasks to cores consists of.

A set fits if all its tasks meet their deadlines beside what is bound to the core. Without blocking and triggers, no task is later
because another one is taken away, so that each part of a set that fits does, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import permutations, product

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.response_times.critical_instant import certain_response
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.optimize.problem import Feasibility, Problem
from amalthea_uros.design.optimize.space import Candidate, Choice, DecisionKind
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.judge.verdict import FAILURES, Verdict
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import MemoryModel
from amalthea_uros.timing.blocking.critical_sections import LockUsage
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, is_preemptive

#: All exchanges of at most so many cores are tried.
MAX_EXCHANGED = 5

#: The core of each task.
Assignment = Mapping[str, str]


@dataclass(slots=True)
class Partition:
    """Tasks to be distributed to cores.

    Attributes
    ----------
    fixed : the processes of each core that stay there
    is_certain : whether each set that was found not to fit misses a deadline for certain
    least : the largest load of a core by what stays there, also of cores that are not on offer
    """

    problem: Problem
    choices: Mapping[str, Choice]
    fixed: Mapping[str, frozenset[str]]
    is_certain: bool = True
    least: Fraction = Fraction(0)
    _loads: dict[tuple[str, str], Fraction] = field(default_factory=dict)
    _class_of: dict[str, str] = field(default_factory=dict)
    _fits: dict[tuple[str, frozenset[str]], Feasibility] = field(default_factory=dict)

    @classmethod
    def of(cls, problem: Problem) -> Partition | None:
        """The tasks whose cores may change; None if something else may change, or tasks depend on those of other cores."""
        varied = [choice for choice in problem.space.choices if len(choice.options) > 1]
        if (
            not varied
            or problem.space.orders
            or any(choice.kind is not DecisionKind.CORE or choice.key != "core" for choice in varied)
        ):
            return None
        if not _is_separable(problem):
            return None
        choices = {choice.object: choice for choice in varied}
        fixed: dict[str, set[str]] = {core: set() for core in problem.present.system.cores}
        for process, cores in allocated_cores(problem.present.system).items():
            for core in cores if process not in choices else ():
                fixed[core].add(process)
        found = cls(problem, choices, {core: frozenset(names) for core, names in fixed.items()})
        return found if found._find_loads() else None

    def _find_loads(self) -> bool:
        """Find the loads of single tasks, and the cores that are alike; False if a load is unknown."""
        for core in self.problem.present.system.cores:
            base = self._analysis(core, frozenset()).processors[core].worst
            if base is None:
                return False
            self._loads[core, ""] = base
            self.least = max(self.least, base)
        for core in self.cores:
            base = self.base(core)
            for task, choice in self.choices.items():
                if core in choice.options:
                    worst = self._analysis(core, frozenset([task])).processors[core].worst
                    if worst is None:
                        return False
                    self._loads[core, task] = worst - base
            self._class_of[core] = next((other for other in self._class_of if self._are_alike(other, core)), core)
        return True

    def _are_alike(self, one: str, other: str) -> bool:
        """Whether two cores differ only in their names and those of their schedulers, with nothing bound to them."""
        if {one, other} & {name for name, _ in self.problem.named}:
            return False
        offers = [choice.options for choice in self.choices.values()]
        if self.fixed[one] or self.fixed[other] or any((one in offer) != (other in offer) for offer in offers):
            return False
        system, settings = self.problem.present
        if settings.frequencies.get(one) != settings.frequencies.get(other):
            return False
        return _nameless(system, one) == _nameless(system, other)

    @property
    def cores(self) -> Sequence[str]:
        """The cores on offer, in the order of the system."""
        offered = {core for choice in self.choices.values() for core in choice.options}
        return [core for core in self.problem.present.system.cores if core in offered]

    def tasks(self) -> list[str]:
        """The tasks, those with the largest load first."""
        return sorted(self.choices, key=lambda task: (-max(self.load(core, task) for core in self.choices[task].options), task))

    def load(self, core: str, task: str) -> Fraction:
        """The load of a core by a task."""
        return self._loads[core, task]

    def base(self, core: str) -> Fraction:
        """The load of a core by what stays there."""
        return self._loads[core, ""]

    def fits(self, core: str, tasks: frozenset[str]) -> bool:
        """Whether tasks are proved to meet their deadlines on a core."""
        key = self._class_of[core], tasks
        if key not in self._fits:
            self._fits[key] = self._judged(core, tasks)
            self.is_certain = self.is_certain and self._fits[key] is not Feasibility.UNKNOWN
        return self._fits[key] is Feasibility.YES

    def minimal(self, core: str, tasks: frozenset[str]) -> frozenset[str]:
        """A part of a set that does not fit, of which each part fits."""
        for task in sorted(tasks):
            if not self.fits(core, tasks - {task}):
                tasks -= {task}
        return tasks

    @property
    def judged_sets(self) -> int:
        """The number of sets that were analysed."""
        return len(self._fits)

    def candidate(self, assignment: Assignment) -> Candidate:
        """The design of an assignment; of those that differ only in the names of like cores, the one with the fewest changes."""
        renamed = _closest(assignment, {task: choice.options[0] for task, choice in self.choices.items()}, self.like)
        moved = [task for task in sorted(renamed) if renamed[task] != self.choices[task].options[0]]
        return tuple(Change(task, "core", renamed[task]) for task in moved)

    @property
    def like(self) -> Sequence[Sequence[str]]:
        """The cores, grouped by those that differ only in their names."""
        groups: dict[str, list[str]] = {}
        for core in self.cores:
            groups.setdefault(self._class_of[core], []).append(core)
        return list(groups.values())

    def _judged(self, core: str, tasks: frozenset[str]) -> Feasibility:
        """Whether a set of tasks is schedulable on a core."""
        try:
            analysis = self._analysis(core, tasks)
        except InvalidArgumentError:
            return Feasibility.NO
        processes = [each for each in analysis.processes if each.verdict is not Verdict.MET and each.deadline is not None]
        if not processes:
            return Feasibility.YES
        is_missed = analysis.processors[core].is_overloaded or any(
            each.verdict in FAILURES
            or (each.deadline is not None and (certain_response(each.name, analysis.solution) or 0) > each.deadline)
            for each in processes
            if each.response is not None
        )
        return Feasibility.NO if is_missed else Feasibility.UNKNOWN

    def _analysis(self, core: str, tasks: frozenset[str]) -> Analysis:
        """The analysis of a core with some tasks, and nothing else."""
        moves = tuple(Change(task, "core", core) for task in sorted(tasks) if self.choices[task].options[0] != core)
        system, settings = self.problem.configure(moves)
        return analyze_system(_only(system, tasks | self.fixed[core]), settings)


def _is_separable(problem: Problem) -> bool:
    """Whether the tasks of a core depend on nothing that others do, do not block each other, and do not share time in slices."""
    system, settings = problem.present
    if settings.memory is not MemoryModel.NONE:
        return False
    stimuli = [system.stimuli_by_name.get(name) for process in system.processes.values() for name in process.stimuli]
    if any(isinstance(stimulus, InterProcess | EventTriggered) for stimulus in stimuli):
        return False
    context = timing_context(system, settings)
    return len(context.scheduled) == len(system.processes) and all(
        is_preemptive(item)
        and item.server is None
        and item.equal_priority in (EqualPriority.FIFO, EqualPriority.EDF)
        and context.protection[item.name] == LockUsage()
        for item in context.scheduled.values()
    )


def _only(system: System, names: Iterable[str]) -> System:
    """A system with only some of its processes, and no chains."""
    kept = frozenset(names)
    requirements = tuple(each for each in system.constraints.requirements if each.process in kept)
    return replace(
        system,
        software=replace(
            system.software,
            tasks=tuple(task for task in system.software.tasks if task.name in kept),
            isrs=tuple(isr for isr in system.software.isrs if isr.name in kept),
        ),
        mapping=replace(
            system.mapping,
            tasks=tuple(each for each in system.mapping.tasks if each.task in kept),
            isrs=tuple(each for each in system.mapping.isrs if each.isr in kept),
        ),
        events=replace(system.events, chains=()),
        constraints=replace(system.constraints, constraints=(), requirements=requirements),
    )


def _nameless(system: System, core: str) -> object:
    """What a core and its schedulers are, without their names."""
    schedulers = [replace(each, name="", cores=()) for each in system.schedulers.values() if core in each.cores]
    shared = [each.cores for each in system.schedulers.values() if core in each.cores and len(each.cores) > 1]
    return replace(system.cores[core], name=""), schedulers, shared


def _closest(assignment: Assignment, present: Assignment, like: Sequence[Sequence[str]]) -> Assignment:
    """The assignment with like cores exchanged so that the fewest tasks are elsewhere than at present."""
    used = set(assignment.values())

    def renamed(names: Sequence[Sequence[str]]) -> Assignment:
        new = {old: name for group, chosen in zip(like, names, strict=True) for old, name in zip(group, chosen, strict=True)}
        return {task: new[core] for task, core in assignment.items()}

    groups = [permutations(group) if len(group) <= MAX_EXCHANGED and used & set(group) else [tuple(group)] for group in like]
    return min(map(renamed, product(*groups)), key=lambda each: sum(each[task] != present[task] for task in each))
