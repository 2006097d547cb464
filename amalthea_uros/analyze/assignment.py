"""Priorities with which all tasks of a core meet their deadlines.

N. C. Audsley, "On priority assignment in fixed priority scheduling", Information Processing Letters 79, 2001 (report YCS 164, 1991):
starting with the lowest priority, any task that meets its deadline at it gets it; if there is no such task, there is no assignment.
This is optimal if a response time depends on the set of tasks with higher priority and not on their order, with offsets too. With
blocking, and if tasks trigger each other, it is only a heuristic: then all orders of a few tasks are tried. Every proposal is
confirmed by the analysis of the whole system.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from itertools import permutations

from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results import Analysis, Claim, ProcessResult, require_analysis
from amalthea_uros.analyze.summary import FAILURES
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.analyze.verdicts import Verdict
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation import UnknownActivationError
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.critical_sections import Protection
from amalthea_uros.timing.event_models import EventModel
from amalthea_uros.timing.preemption import is_preemptive
from amalthea_uros.timing.scheduling import EqualPriority, ScheduledProcess

#: All orders of at most this many tasks are tried.
MAX_PERMUTED = 6

#: Names of tasks, lowest priority first.
Order = Sequence[str]


class Outcome(StrEnum):
    """The result of a search: only `NONE` claims that no assignment of distinct priorities meets all deadlines."""

    KEPT = "kept"
    PROPOSED = "proposed"
    NONE = "none"
    NOT_FOUND = "not found"
    EXCLUDED = "excluded"


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Proposal(Shown):
    """Priorities for the tasks of a core.

    Attributes
    ----------
    priorities : with which all deadlines are met, by the names of tasks: the current ones if they do; None for the `reason`
    """

    core: str
    current: Mapping[str, int | None]
    outcome: Outcome
    priorities: Mapping[str, int] | None = None
    reason: str = ""

    def __repr__(self) -> str:
        return f"<Proposal for {self.core}: {self.outcome}{self.reason and f', {self.reason}'}>"


def propose_priorities(analysis: Analysis) -> list[Proposal]:
    """A proposal for each core that executes tasks; each one takes the ones before it into account."""
    require_analysis(analysis)
    found = []
    for core in analysis.solution.context.system.cores:
        tasks = [item for item in analysis.solution.context.on_core(core) if not item.is_isr]
        if tasks:
            search = _Search(core, tasks, analysis)
            found.append(search.proposal())
            analysis = search.analysis
    return found


def lowest_first(names: Sequence[str], fits: Callable[[str, Order], bool]) -> tuple[list[str], list[str]]:
    """The order of priorities by Audsley's algorithm, and the tasks for which it has no priority.

    Parameters
    ----------
    names : the tasks; those that are more likely to fit at a low priority first
    fits : whether a task meets its deadline directly above the given ones, and below all others
    """
    order: list[str] = []
    remaining = list(names)
    while (fitting := next((name for name in remaining if fits(name, order)), None)) is not None:
        order.append(fitting)
        remaining.remove(fitting)
    return order, remaining


def with_priorities(system: System, priorities: Mapping[str, int]) -> System:
    """A system with other priorities of some tasks."""
    mapping = system.mapping
    tasks = tuple(replace(task, priority=priorities.get(task.task, task.priority)) for task in mapping.tasks)
    return replace(system, mapping=replace(mapping, tasks=tasks))


def _without_chains(system: System) -> System:
    """A system with the same response times, but without what depends on them."""
    return replace(system, events=replace(system.events, chains=()), constraints=replace(system.constraints, constraints=()))


@dataclass(slots=True)
class _Search:
    """The search for the priorities of the tasks of one core.

    Attributes
    ----------
    analysis : of the system with its present priorities, or with the ones that were found
    spoiled : why priorities that meet all deadlines of the core are not proposed
    """

    core: str
    tasks: Sequence[ScheduledProcess]
    analysis: Analysis
    spoiled: str = ""
    _analyses: dict[tuple[str, ...], Analysis] = field(default_factory=dict)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system with the present priorities."""
        return self.analysis.solution.context

    def proposal(self) -> Proposal:
        """The priorities, or why there are none."""
        current = {item.name: item.priority for item in self.tasks}
        reason = next((why for item in self.context.on_core(self.core) if (why := self._obstacle(item))), "")
        if reason:
            return Proposal(core=self.core, current=current, outcome=Outcome.EXCLUDED, reason=reason)
        if self._meets(self.analysis):
            kept = {name: number for name, number in current.items() if number is not None}
            return Proposal(core=self.core, current=current, outcome=Outcome.KEPT, priorities=kept)
        found, outcome, reason = self._searched()
        priorities = {name: found[name] for name in current} if found is not None else None
        return Proposal(core=self.core, current=current, outcome=outcome, priorities=priorities, reason=reason)

    def _searched(self) -> tuple[Mapping[str, int] | None, Outcome, str]:
        is_optimal = self._is_independent_of_order()
        if (load := self.analysis.processors[self.core].worst) is not None and load > 1 and is_optimal:
            return None, Outcome.NONE, f"with any priorities, the tasks need {100 * float(load):.1f} % of the core"
        # The task with the longest deadline usually fits at the lowest priority (deadline-monotonic order).
        monotonic = sorted((item.name for item in self.tasks), key=lambda name: -self._deadline(name))
        order, unfitting = lowest_first(monotonic, self._fits)
        if not unfitting and (found := self._confirmed(order)):
            return found, Outcome.PROPOSED, ""
        if unfitting and is_optimal:
            return None, *self._conclusion([(name, [*order, name, *self._others(order, name)]) for name in unfitting])
        if len(self.tasks) > MAX_PERMUTED:
            return (
                None,
                Outcome.NOT_FOUND,
                self.spoiled or "no assignment was found that meets all deadlines; not all were tried",
            )
        for order in map(list, permutations(monotonic)):
            if all(self._is_met(name, order) for name in order) and (found := self._confirmed(order)):
                return found, Outcome.PROPOSED, ""
        return None, *self._conclusion(self._worst_of_all_orders(monotonic))

    def _conclusion(self, missing: Sequence[tuple[str, Order]]) -> tuple[Outcome, str]:
        """The outcome if each order is like one of these, in which the given task is not known to meet its deadline."""
        if self.spoiled:
            return Outcome.NOT_FOUND, self.spoiled
        if all(self._is_missed(name, order) for name, order in missing):
            return Outcome.NONE, "no assignment of distinct priorities meets all deadlines"
        return (
            Outcome.NOT_FOUND,
            "no assignment of distinct priorities is proved to meet all deadlines; response times are bounds",
        )

    def _worst_of_all_orders(self, names: Sequence[str]) -> Sequence[tuple[str, Order]]:
        """A task of each order that misses its deadline for certain; if there is none, any other one that is not known to meet it."""
        found = []
        for order in permutations(names):
            late = [name for name in order if not self._is_met(name, order)]
            found += [(name, order) for name in sorted(late, key=lambda name: not self._is_missed(name, order))[:1]]
        return found

    # Orders

    def _others(self, order: Order, name: str) -> list[str]:
        """The other tasks, in deadline-monotonic order."""
        others = [item.name for item in self.tasks if item.name not in order and item.name != name]
        return sorted(others, key=lambda other: -self._deadline(other))

    def _fits(self, name: str, order: Order) -> bool:
        return self._is_met(name, [*order, name, *self._others(order, name)])

    def _is_met(self, name: str, order: Order) -> bool:
        return self._result(name, order).verdict is Verdict.MET

    def _is_missed(self, name: str, order: Order) -> bool:
        """Whether a deadline is missed for certain: a bound beyond it does not prove that.

        If others lose activations in this order, its response time is that of all orders in which they do not.
        """
        analysis = self._analysis(order)
        response = analysis.solution.responses.get(name)
        is_late = response is not None and response.claim is Claim.EXACT and (response.worst or 0) > self._deadline(name)
        return is_late or analysis.processes[name].verdict in FAILURES

    def _result(self, name: str, order: Order) -> ProcessResult:
        """The result of a process with the priorities of an order."""
        return self._analysis(order).processes[name]

    def _analysis(self, order: Order) -> Analysis:
        key = tuple(order)
        if key not in self._analyses:
            changed = with_priorities(_without_chains(self.context.system), self._numbers(order))
            self._analyses[key] = analyze_system(changed, self.context.settings)
        return self._analyses[key]

    def _numbers(self, order: Order) -> Mapping[str, int]:
        """Priorities for an order: the present numbers if they are distinct."""
        numbers = sorted({item.priority for item in self.tasks if item.priority is not None})
        if len(numbers) < len(order):
            numbers = list(range(1, len(order) + 1))
        return dict(zip(order, numbers, strict=True))

    def _deadline(self, name: str) -> int:
        return self.analysis.processes[name].deadline or 0

    # Verdicts

    def _confirmed(self, order: Order) -> Mapping[str, int] | None:
        """The priorities of an order with which the analysis of the whole system proves that the deadlines are met."""
        priorities = self._numbers(order)
        changed = analyze_system(with_priorities(self.context.system, priorities), self.context.settings)
        if not self._meets(changed):
            return None
        spoiled = next(_worse(self.analysis, changed), None)
        if spoiled is not None:
            self.spoiled = f"some priorities meet all deadlines on {self.core!r}, but {spoiled!r} is then no longer met"
            return None
        self.analysis = changed
        return priorities

    def _meets(self, analysis: Analysis) -> bool:
        return all(analysis.processes[item.name].verdict is Verdict.MET for item in self.tasks)

    # Processes

    def _obstacle(self, item: ScheduledProcess) -> str:
        """Why a process prevents a proposal for its core."""
        name, solution = item.name, self.analysis.solution
        if name in self.context.reasons or name not in self.context.demands or self._activations(item.process) is None:
            return f"{name!r} could not be analysed: {solution.reasons.get(name, '')}"
        if item.is_isr:
            return ""
        if self.analysis.processes[name].deadline is None:
            return f"{name!r} has no deadline"
        if item.server is not None or item.equal_priority is not EqualPriority.FIFO or item.rank != (0, item.priority):
            return f"{name!r} is not scheduled by a single fixed priority"
        return ""

    def _activations(self, process: Process) -> EventModel | None:
        """The activations of a process, if all response times were zero; None if they are unknown."""
        try:
            return self.context.activations.of(process)
        except UnknownActivationError:
            return None

    def _is_independent_of_order(self) -> bool:
        """Whether a response time depends only on the set of tasks with higher priority."""
        here = self.context.on_core(self.core)
        return not any(self._blocks(item) or self._is_triggered(item.process) for item in here)

    def _blocks(self, item: ScheduledProcess) -> bool:
        """Whether a process can block others."""
        return not is_preemptive(item) or self.context.protection[item.name] != Protection()

    def _is_triggered(self, process: Process) -> bool:
        """Whether other processes activate a process."""
        triggering: list[str] = []

        def output(cause: Process, activations: Callable[[], EventModel]) -> EventModel:
            triggering.append(cause.name)
            return activations()

        self.context.activations.of(process, output)
        return bool(triggering)


def _worse(before: Analysis, after: Analysis) -> Iterator[str]:
    """The names of processes and requirements whose verdict gets worse."""
    old = _verdicts(before)
    for key, verdict in _verdicts(after).items():
        if verdict is not Verdict.MET and verdict is not old[key] and old[key] not in FAILURES:
            yield key[0]


def _verdicts(analysis: Analysis) -> Mapping[tuple[str, str, str], Verdict | None]:
    found = {(process.name, "", "deadline"): process.verdict for process in analysis.processes}
    return found | {(each.name, each.object, each.quantity): each.verdict for each in analysis.requirements}
