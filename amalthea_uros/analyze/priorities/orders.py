"""Orders of the priorities of a core, and which tasks meet their deadlines in them.

N. C. Audsley, "On priority assignment in fixed priority scheduling", Information Processing Letters 79, 2001 (report YCS 164, 1991):
starting with the lowest priority, any task that meets its deadline at it gets it; if there is no such task, there is no assignment.
This is optimal if a response time depends on the set of tasks with higher priority and not on their order: with offsets too, with
critical sections under priority ceilings (K. Bletsas and N. Audsley, "Optimal priority assignment in the presence of blocking",
Information Processing Letters 99, 2006), and for sporadic non-preemptive tasks. It is not if tasks trigger each other, or if tasks with
offsets keep each other off: then other choices among the tasks that fit are tried, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.response_times.critical_instant import certain_response, keep_off_alike
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.verdict import FAILURES, Verdict
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.blocking.critical_sections import LockUsage
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.timing.response import Claim
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, ScheduledProcess, is_preemptive
from amalthea_uros.units import Time, percent_text, time_text

#: Names of tasks, lowest priority first.
Order = Sequence[str]


def lowest_first(names: Sequence[str], fits: Callable[[str, Order], bool]) -> Iterator[tuple[list[str], list[str]]]:
    """Orders of priorities in which each task fits; the first one is that of Audsley's algorithm.

    If no other task fits directly above some, these are an order, too, with the tasks for which there is no priority.

    Parameters
    ----------
    names : the tasks; those that are more likely to fit at a low priority first
    fits : whether a task meets its deadline directly above the given ones, and below all others
    """

    def extended(order: list[str], remaining: list[str]) -> Iterator[tuple[list[str], list[str]]]:
        is_end = True
        for name in remaining:
            if fits(name, order):
                is_end = False
                yield from extended([*order, name], [other for other in remaining if other != name])
        if is_end:
            yield order, remaining

    return extended([], list(names))


def with_priorities(system: System, priorities: Mapping[str, int]) -> System:
    """A system with other priorities of some tasks."""
    mapping = system.mapping
    tasks = tuple(replace(task, priority=priorities.get(task.task, task.priority)) for task in mapping.tasks)
    return replace(system, mapping=replace(mapping, tasks=tasks))


def _without_chains(system: System) -> System:
    """A system with the same response times, but without what depends on them."""
    return replace(system, events=replace(system.events, chains=()), constraints=replace(system.constraints, constraints=()))


@dataclass(slots=True)
class PriorityOrders:
    """Orders of the priorities of some tasks of a core, judged by the response times.

    Attributes
    ----------
    tasks : whose priorities may change; others keep theirs
    analysis : of the system with its present priorities
    levels : the priorities that the tasks share out; empty: the present ones if they are distinct
    is_certain : whether each task that was found not to fit misses its deadline for certain
    """

    core: str
    tasks: Sequence[ScheduledProcess]
    analysis: Analysis
    levels: Sequence[int] = ()
    is_certain: bool = True
    _analyses: dict[tuple[str, ...], Analysis] = field(default_factory=dict)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system with the present priorities."""
        return self.analysis.solution.context

    def obstacle(self) -> str:
        """Why the orders cannot be judged; "" if they can."""
        return next((why for item in self.context.on_core(self.core) if (why := self._obstacle(item))), "")

    def fitting(self) -> Iterator[tuple[list[str], list[str]]]:
        """Orders in which each task meets its deadline where it is placed, and dead ends, as `lowest_first`."""
        return lowest_first(self.monotonic(), self._fits)

    def monotonic(self) -> list[str]:
        """All tasks, in deadline-monotonic order: the one with the longest deadline usually fits at the lowest priority."""
        return sorted((item.name for item in self.tasks), key=lambda name: -self._deadline(name))

    def overload(self) -> str:
        """That the core is overloaded with any priorities; "" if it is not, or not for certain."""
        core = self.analysis.processors[self.core]
        if core.worst is None or not core.is_overloaded or self._is_any_triggered():
            return ""
        return f"with any priorities, the tasks need {percent_text(core.at_least, 1)} % of the core"

    def dead_end(self, order: Order, unfitting: Iterable[str]) -> str:
        """Why no order exists if no task fits directly above some, where `is_independent`; "" if bounds leave it open."""
        missing = [(name, self.missed_by(name, self._placed(name, order))) for name in unfitting]
        if any(late is None for _, late in missing):
            return ""
        where = (
            f"directly above {', '.join(map(repr, order))}, each of the others"
            if order
            else "at the lowest priority, each task"
        )
        misses = ", ".join(f"{name!r} by {f'up to {time_text(late)}' if late else 'an unknown time'}" for name, late in missing)
        return f"{where} misses its deadline: {misses}"

    def is_met(self, name: str, order: Order) -> bool:
        """Whether a task is proved to meet its deadline in an order."""
        return self._analysis(order).processes[name].verdict is Verdict.MET

    def missed_by(self, name: str, order: Order) -> Time | None:
        """By how much at most a task misses its deadline, 0 if that is not known; None if it is not certain that it misses it.

        A bound beyond a deadline does not prove that it is missed. If others lose activations in this order, its response time is
        that of all orders in which they do not.
        """
        analysis = self._analysis(order)
        response, deadline = analysis.solution.responses.get(name), self._deadline(name)
        if response is not None and response.worst is not None and response.worst > deadline:
            is_exact = response.claim is Claim.EXACT
            if is_exact or (certain_response(name, analysis.solution) or 0) > deadline:
                return response.worst - deadline
        return 0 if analysis.processes[name].verdict in FAILURES else None

    def numbers(self, order: Order) -> Mapping[str, int]:
        """Priorities for an order."""
        numbers = sorted(self.levels or {item.priority for item in self.tasks if item.priority is not None})
        if len(numbers) < len(order):
            numbers = list(range(1, len(order) + 1))
        return dict(zip(order, numbers, strict=True))

    @property
    def is_independent(self) -> bool:
        """Whether a response time depends only on the set of tasks with higher priority."""
        if self._is_any_triggered():
            return False
        here = self.context.on_core(self.core)
        if all(is_preemptive(item) and self.context.protection[item.name] == LockUsage() for item in here):
            return True
        return self._has_set_blocking([item for item in here if not item.is_isr])

    def _has_set_blocking(self, tasks: Sequence[ScheduledProcess]) -> bool:
        """Whether blocking depends only on the set of tasks with lower priority."""
        protection = [self.context.protection[item.name] for item in self.context.on_core(self.core)]
        if self.context.open_semaphores or any(uses.has_non_interruptible_group for uses in protection):
            return False
        is_any_locking = any(uses.semaphores for uses in protection)
        if not keep_off_alike(tasks) or (is_any_locking and not all(map(is_preemptive, tasks))):
            return False
        # With two known releases, blocking depends on what can be pending at them.
        released = [known_releases(item.process, self.context.system) for item in self.context.on_core(self.core)]
        return len([each for each in released if each is not None]) < 2

    def _placed(self, name: str, order: Order) -> list[str]:
        """An order with a task directly above some, and below the others in deadline-monotonic order."""
        return [*order, name, *(other for other in self.monotonic() if other not in order and other != name)]

    def _fits(self, name: str, order: Order) -> bool:
        placed = self._placed(name, order)
        is_met = self.is_met(name, placed)
        self.is_certain = self.is_certain and (is_met or self.missed_by(name, placed) is not None)
        return is_met

    def _analysis(self, order: Order) -> Analysis:
        key = tuple(order)
        if key not in self._analyses:
            changed = with_priorities(_without_chains(self.context.system), self.numbers(order))
            self._analyses[key] = analyze_system(changed, self.context.settings)
        return self._analyses[key]

    def _deadline(self, name: str) -> int:
        return self.analysis.processes[name].deadline or 0

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
        if item.order_gap is not None and item.order_gap.is_of_priority and item.server is None and item.rank == (0, 0):
            return ""
        if item.order_gap is not None:
            return f"{name!r}: {item.order_gap}"
        if item.server is not None or item.equal_priority is not EqualPriority.FIFO or item.rank != (0, item.priority):
            return f"{name!r} is not scheduled by a single fixed priority"
        return ""

    def _activations(self, process: Process) -> EventModel | None:
        """The activations of a process, if all response times were zero; None if they are unknown."""
        try:
            return self.context.activations.of(process)
        except UnknownError:
            return None

    def _is_any_triggered(self) -> bool:
        return any(self._is_triggered(item.process) for item in self.context.on_core(self.core))

    def _is_triggered(self, process: Process) -> bool:
        """Whether other processes activate a process."""
        triggering: list[str] = []

        def output(cause: Process, activations: Callable[[], EventModel], _has_fixed_place: bool) -> EventModel:
            triggering.append(cause.name)
            return activations()

        self.context.activations.of(process, output)
        return bool(triggering)
