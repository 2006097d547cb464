"""Priorities with which all tasks of a core meet their deadlines; every proposal is confirmed by the analysis of the whole system."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from enum import StrEnum
from itertools import islice, permutations
from math import factorial

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.priorities.orders import Order, PriorityOrders, with_priorities
from amalthea_uros.analyze.results.analysis import Analysis, require_analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.judge.verdict import FAILURES, Verdict
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess

#: All orders of at most this many tasks are tried.
MAX_PERMUTED = 6
#: At most this many orders in which each task fits where it is placed are confirmed.
MAX_ORDERS = 100

NOT_ALL_TRIED = "no assignment was found that meets all deadlines; not all were tried"
ONLY_BOUNDS = "no assignment of distinct priorities is proved to meet all deadlines; response times are bounds"


class ProposalOutcome(StrEnum):
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
    outcome: ProposalOutcome
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
            search = _AssignmentSearch(PriorityOrders(core, tasks, analysis), analysis)
            found.append(search.proposal())
            analysis = search.analysis
    return found


@dataclass(slots=True)
class _AssignmentSearch:
    """The search for the priorities of the tasks of one core.

    Attributes
    ----------
    analysis : of the system with its present priorities, or with the ones that were found
    spoiled : why priorities that meet all deadlines of the core are not proposed
    """

    orders: PriorityOrders
    analysis: Analysis
    spoiled: str = ""

    @property
    def tasks(self) -> Sequence[ScheduledProcess]:
        """The tasks of the core."""
        return self.orders.tasks

    def proposal(self) -> Proposal:
        """The priorities, or why there are none."""
        current = {item.name: item.priority for item in self.tasks}
        core = self.orders.core
        if reason := self.orders.obstacle():
            return Proposal(core=core, current=current, outcome=ProposalOutcome.EXCLUDED, reason=reason)
        if self._meets(self.analysis):
            kept = {name: number for name, number in current.items() if number is not None}
            return Proposal(core=core, current=current, outcome=ProposalOutcome.KEPT, priorities=kept)
        found, outcome, reason = self._searched()
        priorities = {name: found[name] for name in current} if found is not None else None
        return Proposal(core=core, current=current, outcome=outcome, priorities=priorities, reason=reason)

    def _searched(self) -> tuple[Mapping[str, int] | None, ProposalOutcome, str]:
        if overload := self.orders.overload():
            return None, ProposalOutcome.NONE, overload
        is_independent = self.orders.is_independent
        for order, unfitting in islice(self.orders.fitting(), MAX_ORDERS):
            if not unfitting and (found := self._confirmed(order)):
                return found, ProposalOutcome.PROPOSED, ""
            if unfitting and is_independent:
                return None, *self._conclusion(self.orders.dead_end(order, unfitting))
        if len(self.tasks) > MAX_PERMUTED:
            return None, ProposalOutcome.NOT_FOUND, self.spoiled or NOT_ALL_TRIED
        for order in map(list, permutations(self.orders.monotonic())):
            if all(self.orders.is_met(name, order) for name in order) and (found := self._confirmed(order)):
                return found, ProposalOutcome.PROPOSED, ""
        every = permutations(self.orders.monotonic())
        is_missed = all(any(self.orders.missed_by(name, order) is not None for name in order) for order in every)
        return None, *self._conclusion(f"{factorial(len(self.tasks))} of them were tried" if is_missed else "")

    def _conclusion(self, certificate: str) -> tuple[ProposalOutcome, str]:
        """The outcome if no order is proved to meet all deadlines.

        Parameters
        ----------
        certificate : why each one misses some for certain; "" if that is not known
        """
        if self.spoiled:
            return ProposalOutcome.NOT_FOUND, self.spoiled
        if certificate:
            return ProposalOutcome.NONE, f"no assignment of distinct priorities meets all deadlines: {certificate}"
        return ProposalOutcome.NOT_FOUND, ONLY_BOUNDS

    def _confirmed(self, order: Order) -> Mapping[str, int] | None:
        """The priorities of an order with which the analysis of the whole system proves that the deadlines are met."""
        priorities = self.orders.numbers(order)
        context = self.orders.context
        changed = analyze_system(with_priorities(context.system, priorities), context.settings)
        if not self._meets(changed):
            return None
        spoiled = next(_worse(self.analysis, changed), None)
        if spoiled is not None:
            self.spoiled = f"some priorities meet all deadlines on {self.orders.core!r}, but {spoiled!r} is then no longer met"
            return None
        self.analysis = changed
        return priorities

    def _meets(self, analysis: Analysis) -> bool:
        return all(analysis.processes[item.name].verdict is Verdict.MET for item in self.tasks)


def _worse(before: Analysis, after: Analysis) -> Iterator[str]:
    """The names of processes and requirements whose verdict gets worse."""
    old = _verdicts(before)
    for key, verdict in _verdicts(after).items():
        if verdict is not Verdict.MET and verdict is not old[key] and old[key] not in FAILURES:
            yield key[0]


def _verdicts(analysis: Analysis) -> Mapping[tuple[str, str, str], Verdict | None]:
    found = {(process.name, "", "deadline"): process.verdict for process in analysis.processes}
    return found | {(each.name, each.object, each.quantity): each.verdict for each in analysis.requirements}
