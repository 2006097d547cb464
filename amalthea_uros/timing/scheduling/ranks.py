"""The core or server that executes a process, the policy, the rank, and the preemption mode.

Hierarchies of schedulers follow the help of APP4MC on hierarchical scheduling: the parent decides first, by the parameters of the
association; a child decides only while it is served. The priorities of all levels form a rank that is compared from left to right.
Processes below a server share its budget.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import SERVERS, Parameter, ParameterValue, Parent, Policy, Scheduler
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.scheduling.allocation import (
    BY_PRIORITY,
    deciding_scheduler,
    effective_deadline,
    effective_priority,
    is_without_meaning,
    standard_policy,
)
from amalthea_uros.timing.scheduling.scheduled import (
    EqualPriority,
    OrderGap,
    ScheduledProcess,
    SchedulingContext,
    Server,
    StatedPlace,
)
from amalthea_uros.units import Duration, Time, parse_duration

#: The parameter of OSEK schedulers, which is mandatory in APP4MC; 0 was the value of a task without group when it was an attribute
#: (`osekTaskGroup`, until 0.8.0).
_GROUP, _NO_GROUP = "taskGroup", 0

#: Names of the parameters of servers: those of the standard definitions, and those of AMALTHEA until 1.2.
CAPACITY = ("capacity", "maxBudget")
PERIOD = ("period", "replenishment")
#: The parameter of round robin.
TIME_SLICE = "timeSliceLength"
#: Time slices as text, which models until 1.2 have beside the parameters of a policy of their own.
_SLICE_AS_TEXT = r"(?i)(extended: )?timeslice(length)?(_.+)?"


@dataclass(frozen=True, slots=True)
class _Parameters:
    """The parameters of a process or scheduler for the scheduler above it.

    Attributes
    ----------
    owner : what they belong to, for messages
    """

    owner: str
    priority: int | None
    deadline: Time | None
    period: Time | None
    parameters: Sequence[Parameter]

    def required(self, value: int | None, what: str) -> int:
        """A value that must be set; times must be greater than 0."""
        if value is None or (what != "priority" and value <= 0):
            raise UnknownError(f"{self.owner} has no {what}")
        return value

    def of(self, scheduler: Scheduler, *names: str) -> ParameterValue | None:
        """The first of the named parameters that is set, here or for the whole scheduler."""
        return _of(scheduler, self.parameters, *names)


def _of(scheduler: Scheduler, parameters: Sequence[Parameter], *names: str) -> ParameterValue | None:
    values = {p.name: p.values[0] for p in (*scheduler.parameters, *parameters) if len(p.values) == 1}
    return next((values[name] for name in names if name in values), None)


@dataclass(slots=True)
class SchedulingOrder:
    """Finds the scheduling of processes.

    Attributes
    ----------
    limits : response-time limits of requirements, the deadlines to judge by where none is stated
    """

    system: System
    notes: AnalysisNotes
    limits: Mapping[str, Time] = field(default_factory=dict)
    servers: dict[str, Server] = field(default_factory=dict)
    _served: defaultdict[str, list[TaskAllocation | Parent]] = field(init=False, default_factory=partial(defaultdict, list))
    _with_priority: Counter[tuple[str, int | None]] = field(init=False, default_factory=Counter)
    _lacking: frozenset[str] | None = field(init=False, default=None)
    _roots_of: defaultdict[str, list[str]] = field(init=False, default_factory=partial(defaultdict, list))

    def task(self, allocation: TaskAllocation) -> ScheduledProcess:
        """The scheduling of a task.

        Raises
        ------
        UnknownError : its scheduling cannot be analysed.
        """
        found = self.on_any_core(allocation)
        return replace(found, core=self._core(self.system.schedulers[allocation.scheduler], allocation.cores))

    def on_any_core(self, allocation: TaskAllocation) -> ScheduledProcess:
        """The same, without a core: several ones can execute it."""
        process = self.system.processes.get(allocation.task)
        scheduler = self.system.schedulers.get(allocation.scheduler)
        if process is None or scheduler is None:
            raise UnknownError(f"the scheduler {allocation.scheduler!r} is not defined, or was left out when reading")
        deadline = self.limits.get(process.name) if allocation.deadline is None else allocation.deadline
        # A limit is what is wished for; the scheduler knows only the deadline that the allocation states.
        parameters = _Parameters("it", allocation.priority, allocation.deadline, self._period(process), allocation.parameters)
        found = self._under(scheduler, parameters, ())
        return ScheduledProcess(
            process=process,
            server=found.server,
            is_isr=False,
            priority=allocation.priority,
            deadline=deadline,
            rank=found.rank,
            equal_priority=found.equal_priority,
            slice=found.slice,
            group=found.group,
            order_gap=found.order_gap,
            place=found.place,
        )

    def _period(self, process: Process) -> Time | None:
        stimuli = [self.system.stimuli_by_name.get(name) for name in process.stimuli]
        return min((stimulus.period for stimulus in stimuli if isinstance(stimulus, Periodic)), default=None)

    def _under(self, scheduler: Scheduler, parameters: _Parameters, above: tuple[str, ...]) -> SchedulingContext:
        """The scheduling of a task or child scheduler of a scheduler."""
        if scheduler.name in above:
            raise UnknownError("its schedulers are nested in a cycle")
        above = (*above, scheduler.name)
        policy = self._policy(scheduler)
        if policy == Policy.GROUPING:
            return self._in_group(scheduler, parameters, above)
        if policy in SERVERS:
            return self._in_server(scheduler, parameters, above)
        base = self._of_scheduler(scheduler, above)
        if base.equal_priority is not EqualPriority.FIFO:
            message = f"{scheduler.name!r} cannot be analysed: its parent schedules by {base.equal_priority}"
            self.notes.warning("ANA002", message, scheduler)
            raise UnknownError(f"the parent of its scheduler {scheduler.name!r} schedules by {base.equal_priority}")
        if policy is None:
            message = f"the scheduler {scheduler.name!r} has no policy, so its tasks are not analysed"
            self.notes.warning("ANA001", message, scheduler)
            raise UnknownError(f"its scheduler {scheduler.name!r} has no policy")
        needed = _NEEDED.get(policy)
        if needed == _PRIORITY and parameters.priority is None and self._serves_one(scheduler):
            # Nothing competes with what is alone.
            parameters = replace(parameters, priority=0)
        by_policy = _time_slices if self._states_slices(scheduler) else _BY_POLICY.get(policy)
        if policy == Policy.PRIORITY_BASED_ROUND_ROBIN and not self._is_shared(scheduler, parameters.priority):
            by_policy = _fixed_priority
        if by_policy is None:
            message = f"the policy {policy!r} of the scheduler {scheduler.name!r} cannot be analysed"
            self.notes.warning("ANA002", message, scheduler)
            raise UnknownError(f"there is no analysis for the policy {policy} of its scheduler {scheduler.name!r}")
        if needed == _DEADLINE and not parameters.deadline and self._serves_one(scheduler):
            return replace(base, rank=(*base.rank, 0))
        if gap := self._order_gap(scheduler, parameters):
            place = self._place(scheduler, parameters)
            return replace(base, rank=(*base.rank, 0), equal_priority=EqualPriority.UNKNOWN, order_gap=gap, place=place)
        if policy == Policy.OSEK and parameters.of(scheduler, _GROUP) == _NO_GROUP:
            self.notes.assume(f"task group {_NO_GROUP} of OSEK schedulers means that a task is in no group")
        return by_policy(scheduler, parameters, base)

    def _in_server(self, scheduler: Scheduler, parameters: _Parameters, above: tuple[str, ...]) -> SchedulingContext:
        """The scheduling of a task or scheduler in the budget of a server, by priority."""
        server = self._server(scheduler, above)
        if gap := self._order_gap(scheduler, parameters):
            unknown, place = EqualPriority.UNKNOWN, self._place(scheduler, parameters)
            return SchedulingContext(server=server.name, rank=(0,), equal_priority=unknown, order_gap=gap, place=place)
        if parameters.priority is None and self._serves_one(scheduler):
            return SchedulingContext(server=server.name, rank=())
        return SchedulingContext(server=server.name, rank=(parameters.required(parameters.priority, "priority"),))

    def _order_gap(self, scheduler: Scheduler, parameters: _Parameters) -> OrderGap | None:
        """Why a scheduler that decides for tasks only may serve them in any order; None if it has all that its policy needs."""
        if scheduler.name not in self._incomplete() or self._serves_one(scheduler) or not self._serves_tasks(scheduler):
            return None
        if _NEEDED[standard_policy(scheduler.policy) or ""] == _DEADLINE:
            return OrderGap.OTHER_WITHOUT_DEADLINE if parameters.deadline else OrderGap.NO_DEADLINE
        return OrderGap.NO_PRIORITY if parameters.priority is None else OrderGap.OTHER_WITHOUT_PRIORITY

    def _states_slices(self, scheduler: Scheduler) -> bool:
        """Whether nothing is known of a policy but the time slice of each of its tasks."""
        if not is_without_meaning(scheduler.policy) or scheduler.parent is not None or not self._serves_tasks(scheduler):
            return False
        here = self._tasks_below(scheduler)
        if len(here) < 2 or not all(_slice(scheduler, each.parameters) for each in here):
            return False
        self.notes.assume(
            f"under the policy {scheduler.policy!r} of {scheduler.name!r}, each task that is pending gets its time slice once in a "
            "cycle of all of them"
        )
        return True

    def _place(self, scheduler: Scheduler, parameters: _Parameters) -> StatedPlace | None:
        """The stated place of a task in the order of its scheduler; None if it can have any place."""
        policy, priority, group = standard_policy(scheduler.policy), parameters.priority, parameters.of(scheduler, _GROUP)
        if policy == Policy.DEADLINE_MONOTONIC:
            return StatedPlace(-parameters.deadline, -parameters.deadline) if parameters.deadline else None
        if policy == Policy.EARLIEST_DEADLINE_FIRST or priority is None:
            return None
        if policy != Policy.OSEK or group in (None, _NO_GROUP):
            return StatedPlace(priority, priority)
        # Those of a grouping can be in its group.
        members = [
            each
            for each in self._tasks_below(scheduler)
            if each.scheduler != scheduler.name or _of(scheduler, each.parameters, _GROUP) == group
        ]
        known = [level for each in members if (level := effective_priority(each, self.system)) is not None]
        return StatedPlace(priority, max(known)) if len(known) == len(members) else None

    def _incomplete(self) -> frozenset[str]:
        """The schedulers that decide for a task without the priority or the deadline that their policy needs."""
        if self._lacking is None:
            schedulers = self.system.schedulers.values()
            lacking = (by for by in schedulers if any(self._lacks(task, by) for task in self._tasks_below(by)))
            self._lacking = frozenset(by.name for by in lacking)
        return self._lacking

    def _lacks(self, task: TaskAllocation, scheduler: Scheduler) -> bool:
        """Whether a task has no priority, or no deadline, and the policy of its scheduler needs it."""
        needed = _NEEDED.get(standard_policy(scheduler.policy) or "")
        if needed == _DEADLINE:
            return not effective_deadline(task, self.system)
        return needed == _PRIORITY and effective_priority(task, self.system) is None

    def _below(self, scheduler: Scheduler) -> Sequence[TaskAllocation | Parent]:
        """The tasks and schedulers for which a scheduler decides; groupings decide nothing."""
        if not self._served:
            deciding = [each for each in self.system.schedulers.values() if standard_policy(each.policy) != Policy.GROUPING]
            parents = [each.parent for each in deciding if each.parent is not None]
            below: list[TaskAllocation | Parent] = [*self.system.mapping.tasks, *parents]
            for each in below:
                if (by := deciding_scheduler(each.scheduler, self.system)) is not None:
                    self._served[by.name].append(each)
                    self._with_priority[by.name, effective_priority(each, self.system)] += 1
        return self._served[scheduler.name]

    def _tasks_below(self, scheduler: Scheduler) -> Sequence[TaskAllocation]:
        return [each for each in self._below(scheduler) if isinstance(each, TaskAllocation)]

    def _serves_tasks(self, scheduler: Scheduler) -> bool:
        """Whether a scheduler decides for no other scheduler that decides something itself."""
        return len(self._tasks_below(scheduler)) == len(self._below(scheduler))

    def _serves_one(self, scheduler: Scheduler) -> bool:
        """Whether a scheduler decides for a single task or scheduler."""
        return len(self._below(scheduler)) == 1

    def _policy(self, scheduler: Scheduler) -> str | None:
        """The standard name of the policy of a scheduler."""
        standard = standard_policy(scheduler.policy)
        if standard == scheduler.policy:
            return standard
        self.notes.assume(f"the policy {scheduler.policy!r} is interpreted as {standard}")
        return standard

    def _in_group(self, scheduler: Scheduler, parameters: _Parameters, above: tuple[str, ...]) -> SchedulingContext:
        """The scheduling in a grouping: its parent decides, by the parameters of the process, or else of the group."""
        if scheduler.parent is None:
            raise UnknownError(f"the grouping {scheduler.name!r} has no parent scheduler")
        parent, of_group = self._parent(scheduler)
        merged = _Parameters(
            owner=parameters.owner,
            priority=of_group.priority if parameters.priority is None else parameters.priority,
            deadline=of_group.deadline if parameters.deadline is None else parameters.deadline,
            period=parameters.period,
            parameters=(*of_group.parameters, *parameters.parameters),
        )
        return self._under(parent, merged, above)

    def _of_scheduler(self, scheduler: Scheduler, above: tuple[str, ...]) -> SchedulingContext:
        """The scheduling of a scheduler itself; its rank precedes those of its tasks."""
        if scheduler.parent is None:
            return SchedulingContext()
        parent, parameters = self._parent(scheduler)
        if scheduler.policy not in SERVERS and self._is_shared(parent, parameters.priority):
            message = f"{scheduler.name!r} shares its priority in {parent.name!r} with others"
            self.notes.warning("ANA002", message, scheduler)
            raise UnknownError(f"its scheduler {scheduler.name!r} shares its priority in {parent.name!r} with others")
        return self._under(parent, parameters, above)

    def _parent(self, scheduler: Scheduler) -> tuple[Scheduler, _Parameters]:
        assert scheduler.parent is not None
        parent = self.system.schedulers.get(scheduler.parent.scheduler)
        if parent is None:
            raise UnknownError(f"the parent scheduler of {scheduler.name!r} is not defined in the model")
        association = scheduler.parent
        period = _time(_of(scheduler, association.parameters, *PERIOD))
        deadline = period if association.deadline is None else association.deadline
        owner = f"its scheduler {scheduler.name!r}, below {parent.name!r},"
        return parent, _Parameters(owner, association.priority, deadline, period, association.parameters)

    def _is_shared(self, parent: Scheduler, priority: int | None) -> bool:
        """Whether several schedulers or tasks have a priority, under a policy that uses it."""
        policy = standard_policy(parent.policy)
        if policy not in BY_PRIORITY and policy not in SERVERS:
            return False
        return bool(self._below(parent)) and self._with_priority[parent.name, priority] > 1

    def _server(self, scheduler: Scheduler, above: tuple[str, ...]) -> Server:
        if scheduler.name not in self.servers:
            found = self._of_scheduler(scheduler, above)
            stated = scheduler.parent.parameters if scheduler.parent else ()
            parameters = _Parameters(f"the server {scheduler.name!r}", None, None, None, stated)
            self.servers[scheduler.name] = Server(
                scheduler=scheduler,
                budget=parameters.required(_time(parameters.of(scheduler, *CAPACITY)), "capacity"),
                period=parameters.required(_time(parameters.of(scheduler, *PERIOD)), "period"),
                core=self._core(scheduler, ()),
                server=found.server,
                rank=found.rank,
                equal_priority=found.equal_priority,
                deadline=found.deadline,
                slice=found.slice,
            )
        return self.servers[scheduler.name]

    def _core(self, scheduler: Scheduler, wanted: tuple[str, ...]) -> str:
        root, served = scheduler, scheduler.cores
        while root.parent is not None and root.parent.scheduler in self.system.schedulers:
            root = self.system.schedulers[root.parent.scheduler]
            served = served or root.cores
        cores = [core for core in served if core in wanted] if wanted else list(served)
        if len(cores) != 1:
            reason = _no_single_core(scheduler, served, wanted, cores)
            if cores:
                raise UnknownError(reason)
            self.notes.warning("ANA002", f"tasks of the scheduler {scheduler.name!r} are not analysed: {reason}", scheduler)
            raise UnknownError(reason)
        others = [name for name in self._roots().get(cores[0], ()) if name != root.name]
        if others:
            message = f"the core {cores[0]!r} is shared by the schedulers {root.name!r} and {others[0]!r}"
            self.notes.warning("ANA002", message, scheduler)
            raise UnknownError(f"its core {cores[0]!r} is shared by the schedulers {root.name!r} and {others[0]!r}")
        return cores[0]

    def _roots(self) -> Mapping[str, Sequence[str]]:
        """The schedulers of each core that are below no other one; asked for each task, and so found once."""
        if not self._roots_of:
            for scheduler in self.system.schedulers.values():
                for core in dict.fromkeys(scheduler.cores) if scheduler.parent is None else ():
                    self._roots_of[core].append(scheduler.name)
        return self._roots_of

    def isr(self, name: str, controller_name: str, priority: int | None) -> ScheduledProcess:
        """The scheduling of an interrupt service routine; raises as `task`."""
        process = self.system.processes.get(name)
        controller = self.system.interrupt_controllers.get(controller_name)
        if process is None or controller is None:
            raise UnknownError(f"the interrupt controller {controller_name!r} is not defined, or was left out when reading")
        if len(controller.cores) != 1:
            cores = f"several cores can execute it: {', '.join(controller.cores)}"
            raise UnknownError(cores if controller.cores else f"{controller_name!r} is not responsible for a core")
        if controller.overhead:
            raise UnknownError(f"{controller_name!r} executes work of its own at each interrupt, which cannot be analysed")
        rank = (1, priority or 0)
        return ScheduledProcess(process=process, core=controller.cores[0], is_isr=True, priority=priority, rank=rank)


def _slice(scheduler: Scheduler, parameters: Sequence[Parameter]) -> Time | None:
    """The time slice of a task; None if none is stated, or several."""
    stated = _time(_of(scheduler, parameters, TIME_SLICE))
    texts = [value for each in parameters if re.fullmatch(_SLICE_AS_TEXT, each.name) for value in each.values]
    if stated is None and len(texts) == 1 and isinstance(texts[0], str):
        with suppress(ValueError):
            return parse_duration(texts[0])
    return stated


def _time(value: ParameterValue | None) -> Time | None:
    return value.time if isinstance(value, Duration) else None


def _no_single_core(scheduler: Scheduler, served: Sequence[str], wanted: Sequence[str], cores: Sequence[str]) -> str:
    """Why it is not one core that executes a task."""
    if cores:
        return f"several cores can execute it: {', '.join(cores)}"
    if not served:
        return f"its scheduler {scheduler.name!r} is not responsible for a core"
    return (
        f"its affinity is to {', '.join(wanted)}, but its scheduler {scheduler.name!r} is responsible for {', '.join(served)}"
    )


# Policies


def _fixed_priority(_scheduler: Scheduler, parameters: _Parameters, base: SchedulingContext) -> SchedulingContext:
    return replace(base, rank=(*base.rank, parameters.required(parameters.priority, "priority")))


def _osek(scheduler: Scheduler, parameters: _Parameters, base: SchedulingContext) -> SchedulingContext:
    found, group = _fixed_priority(scheduler, parameters, base), parameters.of(scheduler, _GROUP)
    return found if group in (None, _NO_GROUP) else replace(found, group=f"{scheduler.name}/{group}")


def _round_robin(scheduler: Scheduler, parameters: _Parameters, base: SchedulingContext) -> SchedulingContext:
    found = _fixed_priority(scheduler, parameters, base)
    length = parameters.required(_slice(scheduler, parameters.parameters), TIME_SLICE)
    return replace(found, equal_priority=EqualPriority.ROUND_ROBIN, slice=length)


def _time_slices(scheduler: Scheduler, parameters: _Parameters, base: SchedulingContext) -> SchedulingContext:
    length = parameters.required(_slice(scheduler, parameters.parameters), TIME_SLICE)
    return replace(base, rank=(*base.rank, 0), equal_priority=EqualPriority.TIME_SLICES, slice=length)


def _deadline_monotonic(_scheduler: Scheduler, parameters: _Parameters, base: SchedulingContext) -> SchedulingContext:
    return replace(base, rank=(*base.rank, -parameters.required(parameters.deadline, "deadline")))


def _rate_monotonic(scheduler: Scheduler, parameters: _Parameters, base: SchedulingContext) -> SchedulingContext:
    period = _time(parameters.of(scheduler, "period")) or parameters.period
    return replace(base, rank=(*base.rank, -parameters.required(period, "period")))


def _earliest_deadline_first(_scheduler: Scheduler, parameters: _Parameters, base: SchedulingContext) -> SchedulingContext:
    return replace(base, equal_priority=EqualPriority.EDF, deadline=parameters.required(parameters.deadline, "deadline"))


_PRIORITY, _DEADLINE = "priority", "deadline"
#: The parameter by which policies order tasks: a deadline of the allocation, not one that is only required.
_NEEDED: Mapping[str, str] = {
    **dict.fromkeys((Policy.FIXED_PRIORITY_PREEMPTIVE, Policy.OSEK, Policy.PRIORITY_BASED_ROUND_ROBIN, *SERVERS), _PRIORITY),
    **dict.fromkeys((Policy.EARLIEST_DEADLINE_FIRST, Policy.DEADLINE_MONOTONIC), _DEADLINE),
}
#: The scheduling by each policy.
_BY_POLICY: Mapping[str, Callable[[Scheduler, _Parameters, SchedulingContext], SchedulingContext]] = {
    Policy.FIXED_PRIORITY_PREEMPTIVE: _fixed_priority,
    Policy.OSEK: _osek,
    Policy.PRIORITY_BASED_ROUND_ROBIN: _round_robin,
    Policy.DEADLINE_MONOTONIC: _deadline_monotonic,
    Policy.RATE_MONOTONIC: _rate_monotonic,
    Policy.EARLIEST_DEADLINE_FIRST: _earliest_deadline_first,
}
#: The policies that decide about tasks without a budget.
ANALYSED = tuple(_BY_POLICY)
