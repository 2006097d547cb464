"""Programs of processes: their activities, in the order in which jobs reach them, as operations."""

from __future__ import annotations

import collections
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    ClearEvent,
    Communication,
    Count,
    Demand,
    Execute,
    ExecutionNeed,
    Group,
    Incomplete,
    LabelAccess,
    Loop,
    Migrate,
    ModeAccess,
    ModeOperation,
    ProbabilitySwitch,
    RaiseEvent,
    Receive,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    Send,
    SenderReceiverAccess,
    ServerCall,
    ServerCallKind,
    SetEvent,
    Switch,
    Terminate,
    Trigger,
    WaitEvent,
    Waiting,
)
from amalthea_uros.perf.conditions import Condition
from amalthea_uros.perf.distributions import Statistics
from amalthea_uros.perf.events import (
    ChannelChange,
    ChannelEvent,
    CustomEvent,
    Event,
    LabelChange,
    LabelEvent,
    ModeChange,
    ModeLabelEvent,
    RunnableChange,
    RunnableEvent,
    SemaphoreChange,
    SemaphoreEvent,
)
from amalthea_uros.perf.os import Scheduler
from amalthea_uros.perf.software import Isr, Preemption, Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.simulate.layout import (
    EXECUTION_NUMBER,
    EXECUTION_SIZE,
    GROUP_SIZE,
    LOOP_SIZE,
    ORDERED_PARTS,
    PARTS,
    PARTS_TOTAL,
)
from amalthea_uros.simulate.operations import (
    ACTIVE,
    AGAIN,
    ASK,
    AWAIT,
    BEGIN_EXECUTION,
    BEGIN_RUNNABLE,
    CHOOSE,
    CLEAR_EVENT,
    COUNT,
    DRAW,
    END,
    END_EXECUTION,
    END_RUNNABLE,
    EXCLUSIVE,
    EXECUTE,
    FIRE,
    JUMP,
    MASK,
    NEXT,
    NOTE,
    OBSERVE,
    POINT,
    RECEIVE,
    REPEAT,
    REQUEST,
    SEND,
    SERVE,
    SERVED,
    SET_EVENT,
    SET_MODE,
    SHUFFLE,
    STEP_MODE,
    TEST,
    TEST_MESSAGE,
    UNLOCK,
    UNMASK,
    WAIT_EVENT,
)
from amalthea_uros.simulate.options import Mode
from amalthea_uros.simulate.program.code import Argument, Code, Label, Table
from amalthea_uros.simulate.program.modes import Modes
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.simulate.program.resources import Resources, constant
from amalthea_uros.simulate.program.watches import Source, Watches
from amalthea_uros.simulate.sampling.streams import Stream
from amalthea_uros.timing.counters import reached
from amalthea_uros.timing.critical_sections import spinlocks_of, waits_actively
from amalthea_uros.timing.dataflow.positions import MAX_CALL_DEPTH
from amalthea_uros.timing.memory import count_of
from amalthea_uros.timing.multiframe import Frame
from amalthea_uros.timing.notes import UnknownDemandError
from amalthea_uros.timing.server_calls import obstacle
from amalthea_uros.timing.settings import Memory
from amalthea_uros.trace.table import EntityKind, EventKind

#: An operation that chains and triggers add to a program, with its arguments.
Operation: TypeAlias = tuple[int, Argument, Argument]
#: A program with more operations is not built.
MAX_OPERATIONS = 1_000_000
_MODE_CHANGES = {
    ModeOperation.READ: ModeChange.READ,
    ModeOperation.SET: ModeChange.WRITE,
    ModeOperation.INCREMENT: ModeChange.INCREMENT,
    ModeOperation.DECREMENT: ModeChange.DECREMENT,
}


@dataclass(slots=True)
class Hooks:
    """What chains and event stimuli add to the program of a process: at its start and end, and before and after its activities."""

    start: list[Operation] = field(default_factory=list)
    end: list[Operation] = field(default_factory=list)
    before: dict[int, list[Operation]] = field(default_factory=dict)
    after: dict[int, list[Operation]] = field(default_factory=dict)

    def all(self) -> Iterator[Operation]:
        """All of them."""
        for operations in (self.start, *self.before.values(), *self.after.values(), self.end):
            yield from operations


@dataclass(slots=True)
class BodyCompiler:
    """Makes programs of processes.

    Attributes
    ----------
    processes, stimuli : their records
    queues : of messages with arrivals of their own, by process and source
    is_noted : whether events of runnables and labels are recorded
    watches : what is observed apart from jobs and chains
    """

    resources: Resources
    modes: Modes
    processes: dict[str, int]
    stimuli: dict[str, int]
    queues: dict[tuple[str, str], int]
    is_noted: bool
    watches: Watches

    def process(self, process: Process, core: str, hooks: Hooks, scheduler: Scheduler | None, in_group: bool) -> Code:
        """The program of a process.

        Parameters
        ----------
        scheduler : whose decision at the end of jobs takes time
        in_group : whether it belongs to a group of tasks, which are preempted at schedule points only

        Raises
        ------
        NotSimulatedError : something in it cannot be simulated.
        """
        try:
            return _Body(self, process, core, hooks, in_group).compile(scheduler)
        except UnknownDemandError as error:
            raise NotSimulatedError(str(error)) from None

    def decision(self, scheduler: Scheduler, core: str) -> Code:
        """The program of a decision of a scheduler; raises as `process`."""
        body = _Body(self, None, core, Hooks(), False)
        try:
            body.activities(scheduler.overhead, ())
        except UnknownDemandError as error:
            raise NotSimulatedError(str(error)) from None
        if self.is_noted:
            body.code.add(NOTE, int(EventKind.SCHEDULE), self.resources.entities.number(EntityKind.SCHEDULER, scheduler.name))
        body.code.add(END)
        return body.code


@dataclass(slots=True)
class _Body:
    """The program of one process while it is made."""

    owner: BodyCompiler
    process: Process | None
    core: str
    hooks: Hooks
    in_group: bool
    code: Code = field(default_factory=Code)
    end: Label = field(default_factory=Label)
    number: int = 0
    places: collections.Counter[int] = field(default_factory=collections.Counter)
    masks: int = 0
    executions: dict[str, int] = field(default_factory=dict)

    @property
    def resources(self) -> Resources:
        return self.owner.resources

    def _place(self) -> str:
        """What draws values here, and nowhere else: the random numbers of a place depend neither on others nor on a trace."""
        name = self.process.name if self.process is not None else f"decision on {self.core}"
        self.places[self.number] += 1
        return f"{name} activity {self.number} {self.places[self.number]}"

    def compile(self, scheduler: Scheduler | None) -> Code:
        process, model = self.process, self.resources.context.demand_model
        assert process is not None
        if reached(process.activities, model.sites.sizes) > MAX_OPERATIONS:
            raise _too_many_activities()
        entry, exit_ = model.overheads.of_isr(process, self.core) if isinstance(process, Isr) else (None, None)
        copies = model.copies(process, self.core) if model.settings.memory is Memory.IMPLICIT else []
        self._add_all(self.hooks.start)
        self._demand(entry)
        for kind, frame in copies:
            if kind is AccessKind.READ:
                self._frame(frame)
        self.activities(process.activities, ())
        self.code.mark(self.end)
        for kind, frame in copies:
            if kind is AccessKind.WRITE:
                self._frame(frame)
        self._demand(exit_)
        if scheduler is not None:
            self.number = 0
            for activity in scheduler.overhead:
                self._activity(activity, ())
        self._add_all(self.hooks.end)
        self.code.add(END)
        return self.code

    def _add_all(self, operations: Iterable[Operation]) -> None:
        for operation in operations:
            self.code.add(*operation)

    # Time.

    def _execute(self, stream: Stream) -> None:
        only = constant(stream)
        if only is None:
            self.code.add(DRAW, self.resources.stream(stream))
        elif only > 0:
            self.code.add(EXECUTE, only)

    def _demand(self, demand: Demand | None) -> None:
        if demand is not None:
            ticks = self.resources.context.demand_model.ticks(demand, self.core)
            self._execute(self.resources.ticks(ticks, self.core, Fraction(1), self._place()))

    def _frame(self, frame: Frame) -> None:
        self._execute(self.resources.frame(frame, self.core, self._place()))

    def _access(self, name: str, kind: AccessKind, times: Count | float | None) -> None:
        model = self.resources.context.demand_model
        if model.settings.memory is not Memory.NONE:
            self._frame(model.access(self.core, name, kind, times))

    # Activities.

    def activities(self, activities: Sequence[Activity], above: tuple[str, ...]) -> None:
        """Append activities; they are numbered as in `timing.dataflow.positions`."""
        for activity in activities:
            self.number += 1
            number = self.number
            if len(self.code.operations) > MAX_OPERATIONS:
                raise _too_many_activities()
            # Only the service of the operating system knows whether an occurrence counts.
            is_counted = getattr(activity, "counter", None) is not None
            if is_counted:
                self._services(activity)
            skips = self._skips(activity)
            if isinstance(activity, Call):
                self._call(activity, above)
                self._return()
            else:
                self._add_all(self.hooks.before.get(number, ()))
                if not is_counted:
                    self._services(activity)
                self._activity(activity, above)
                self._add_all(self.hooks.after.get(number, ()))
            for label in skips:
                self._mark(label)

    def _services(self, activity: Activity) -> None:
        """The time of the services of the operating system that an activity calls."""
        for demand in self.resources.context.demand_model.overheads.of_activity(activity, self.core):
            self._demand(demand)

    def _return(self) -> None:
        """After a call, other cooperative tasks can go first."""
        if getattr(self.process, "preemption", None) is Preemption.COOPERATIVE and not self.in_group:
            self.code.add(POINT)

    def _activity(self, activity: Activity, above: tuple[str, ...]) -> None:
        match activity:
            case Execute(demand=demand):
                self._demand(demand)
            case ExecutionNeed(needs=needs):
                for name, need in needs:
                    factor = self.resources.context.demand_model.ticks_per_unit(name, self.core)
                    self._execute(self.resources.ticks(need, self.core, factor, f"{self._place()} {name}"))
            case LabelAccess(label=label, kind=kind, communication=communication, times=times):
                self._access(label, kind, times)
                self._label_accessed(label, kind, communication, above)
            case SenderReceiverAccess(label=label, kind=kind):
                self._check(activity)
                self._access(label, kind, None)
                self._label_accessed(label, kind, None, above)
            case Send(channel=channel, elements=elements):
                self._access(channel, AccessKind.WRITE, max(1, elements))
                self.code.add(SEND, self.owner.modes.channel(channel), elements)
                self._observe(ChannelEvent, channel, ChannelChange.SEND, above)
            case Receive():
                self._receive(activity)
                self._observe(ChannelEvent, activity.channel, ChannelChange.RECEIVE, above)
            case Group():
                self._group(activity, above)
            case ProbabilitySwitch():
                self._choose(activity, above)
            case Switch():
                self._switch(activity, above)
            case Loop(activities=inner, condition=condition):
                self._loop(inner, condition, above)
            case SemaphoreAccess():
                self._semaphore(activity, above)
            case Trigger(stimulus=stimulus):
                self.code.add(FIRE, self._stimulus(stimulus))
            case SetEvent() | ClearEvent() | WaitEvent():
                self._os_events(activity)
            case ModeAccess():
                self._mode(activity)
                self._observe(ModeLabelEvent, activity.label, _MODE_CHANGES[activity.operation], above)
            case ServerCall():
                self._server_call(activity)
            case SchedulePoint():
                self.code.add(POINT)
            case Terminate():
                for _ in range(self.masks):
                    self.code.add(UNMASK)
                self.code.add(JUMP, self.end)
            case RaiseEvent(event=event):
                # What it activates is among the hooks.
                self._observe(CustomEvent, event, None, above)
            case Migrate():
                raise NotSimulatedError("it migrates to another scheduler, which is not simulated")
            case Incomplete(reason=reason, is_access=is_access):
                if not is_access or self.resources.context.settings.memory is not Memory.NONE:
                    raise NotSimulatedError(f"it contains {reason}")

    def _skips(self, activity: Activity) -> list[Label | None]:
        """Labels to which a job goes if an activity does not take effect: then it is no event of a chain, either."""
        labels = [self._counted(activity, getattr(activity, "counter", None))]
        if isinstance(activity, Call) and activity.times is None:
            runnable = self.resources.context.system.runnables.get(activity.runnable)
            labels.append(None if runnable is None else self._tested(runnable.condition))
        return labels

    def _counted(self, owner: Activity, counter: Counter | None) -> Label | None:
        """A label to which a job goes if a counter does not let this time take effect."""
        name = self.process.name if self.process is not None else ""
        queue = self.owner.queues.get((name, counter.source)) if counter is not None and counter.arrivals is not None else None
        place = queue or self.resources.counter(owner, counter)
        if not place:
            return None
        label = Label()
        self.code.add(TEST_MESSAGE if queue else COUNT, place, label)
        return label

    def _mark(self, label: Label | None) -> None:
        if label is not None:
            self.code.mark(label)

    def _label_accessed(
        self, label: str, kind: AccessKind, communication: Communication | None, above: tuple[str, ...]
    ) -> None:
        # In traces, schedulers do not access labels.
        if self.owner.is_noted and self.process is not None and label in self.resources.context.system.labels:
            event = EventKind.READ if kind is AccessKind.READ else EventKind.WRITE
            self.code.add(NOTE, int(event), self.resources.entities.number(EntityKind.LABEL, label))
        self._observe(LabelEvent, label, LabelChange(kind), above, communication)

    def _receive(self, receive: Receive) -> None:
        most = max(1, receive.elements)
        least = min(receive.at_least, most)
        self._access(receive.channel, AccessKind.READ, Count(least=least, mean=most, most=most))
        takes = receive.operation is not None and "take" in receive.operation
        self.code.add(RECEIVE, self.owner.modes.channel(receive.channel), receive.elements if takes else 0)

    def _call(self, call: Call, above: tuple[str, ...]) -> None:
        runnable = self.resources.context.system.runnables.get(call.runnable)
        if runnable is None:
            raise NotSimulatedError(f"the runnable {call.runnable!r} is not defined in the model")
        if runnable.name in above:
            raise NotSimulatedError(f"the runnable {runnable.name!r} calls itself")
        if len(above) > MAX_CALL_DEPTH:
            raise NotSimulatedError(f"calls are nested deeper than {MAX_CALL_DEPTH} levels")
        number = self.number
        again, done = self._repeated(call)
        skip = self._tested(runnable.condition) if call.times is not None else None
        # It starts and ends each time.
        self._add_all(self.hooks.before.get(number, ()))
        service = self.resources.services.get(runnable.name, 0)
        site = self.resources.site(runnable.name) if self.owner.is_noted else 0
        if site:
            self.code.add(BEGIN_RUNNABLE, site)
        execution = self._execution(runnable.name)
        if execution:
            self.code.add(BEGIN_EXECUTION, execution)
        self._observe(RunnableEvent, runnable.name, RunnableChange.START, above)
        if service:
            self.code.add(SERVE, service)
        self.activities(runnable.activities, (*above, runnable.name))
        if service:
            self.code.add(SERVED, service)
        self._observe(RunnableEvent, runnable.name, RunnableChange.TERMINATE, above)
        if execution:
            self.code.add(END_EXECUTION, execution)
        if site:
            self.code.add(END_RUNNABLE, site)
        self._add_all(self.hooks.after.get(number, ()))
        self._mark(skip)
        if again is not None:
            self.code.add(JUMP, again)
        self._mark(done)

    def _execution(self, runnable: str) -> int:
        """The record of the executions of a runnable in this process, if they are measured, or 0."""
        number = self.owner.watches.measured.get(runnable)
        if number is None:
            return 0
        if runnable not in self.executions:
            self.executions[runnable] = self.resources.image.record(EXECUTION_SIZE, {EXECUTION_NUMBER: number})
        return self.executions[runnable]

    def _observe(
        self,
        kind: type[Event],
        name: str,
        change: StrEnum | None,
        above: tuple[str, ...],
        communication: Communication | None = None,
    ) -> None:
        """Report that an event has occurred here, if it is watched."""
        if self.process is not None:
            source = Source(kind, name, change, above[-1] if above else None, self.process.name, communication)
            number = self.owner.watches.number(source)
            if number is not None:
                self.code.add(OBSERVE, number)

    def _repeated(self, call: Call) -> tuple[Label | None, Label | None]:
        """The begin and the end of a loop around what a call stands for, if it stands for several."""
        if call.times is None:
            return None, None
        least, mean, most = count_of(call.times)
        loop, done = self.resources.image.record(LOOP_SIZE), Label()
        passes = Statistics(lower=least, average=float(mean), upper=most)
        self.code.add(REPEAT, loop, self.resources.count(passes, f"{self._place()} passes"))
        again = self.code.here()
        self.code.add(AGAIN, loop, done)
        return again, done

    def _tested(self, condition: Condition | None) -> Label | None:
        """A label to which a job goes if a condition is false."""
        if condition is None:
            return None
        label = Label()
        self.code.add(TEST, self.owner.modes.condition(condition), label)
        return label

    def _group(self, group: Group, above: tuple[str, ...]) -> None:
        if not group.interruptible:
            self.code.add(MASK)
            self.masks += 1
        if group.ordered or len(group.activities) < 2 or self.resources.options.mode is not Mode.SAMPLED:
            self.activities(group.activities, above)
        else:
            self._in_any_order(group.activities, above)
        if not group.interruptible:
            self.code.add(UNMASK)
            self.masks -= 1

    def _in_any_order(self, activities: Sequence[Activity], above: tuple[str, ...]) -> None:
        image, total, done = self.resources.image, len(activities), Label()
        ordered, _ = image.items([0] * total)
        parts, _ = image.items([0] * total)
        group = image.record(GROUP_SIZE, {ORDERED_PARTS: ordered, PARTS: parts, PARTS_TOTAL: total})
        self.code.add(SHUFFLE, group, self.resources.order(f"{self._place()} order"))
        following = self.code.here()
        self.code.add(NEXT, group, done)
        labels = []
        for activity in activities:
            labels.append(self.code.here())
            self.activities([activity], above)
            self.code.add(JUMP, following)
        self.code.tables.append(Table(labels, ordered))
        self.code.mark(done)

    def _choose(self, switch: ProbabilitySwitch, above: tuple[str, ...]) -> None:
        if not switch.branches:
            return
        table, _ = self.resources.image.items([0] * len(switch.branches))
        labels, done = [], Label()
        if self.resources.options.mode in (Mode.WORST, Mode.BEST) and self.process is not None:
            only = self._extreme_branch(switch)
            jump = Label()
            self.code.add(JUMP, jump)
        else:
            only, jump = -1, Label()
            weights = [branch.weight for branch in switch.branches]
            self.code.add(CHOOSE, self.resources.choice(weights, f"{self._place()} branch"), table)
        for index, branch in enumerate(switch.branches):
            labels.append(self.code.here())
            if index == only:
                self.code.mark(jump)
            self.activities(branch.activities, above)
            self.code.add(JUMP, done)
        self.code.tables.append(Table(labels, table))
        self.code.mark(done)

    def _extreme_branch(self, switch: ProbabilitySwitch) -> int:
        """The branch with the longest demand in the worst case, or with the shortest one in the best."""
        model, process = self.resources.context.demand_model, self.process
        assert process is not None
        weights = [branch.weight for branch in switch.branches]
        possible = [index for index, weight in enumerate(weights) if weight or not any(weights)]
        demands = {index: model.of_activities(process, switch.branches[index].activities, self.core) for index in possible}
        if self.resources.options.mode is Mode.WORST:
            return max(possible, key=lambda index: demands[index].worst)
        return min(possible, key=lambda index: demands[index].best)

    def _switch(self, switch: Switch, above: tuple[str, ...]) -> None:
        done = Label()
        for case in switch.cases:
            if case.condition is None:
                raise NotSimulatedError("a branch of a switch has no condition")
            following = self._tested(case.condition)
            self.activities(case.activities, above)
            self.code.add(JUMP, done)
            self._mark(following)
        self.activities(switch.default or (), above)
        self.code.mark(done)

    def _loop(self, activities: Sequence[Activity], condition: Condition | None, above: tuple[str, ...]) -> None:
        if condition is None:
            raise NotSimulatedError("a loop has no condition")
        start = self.code.here()
        done = self._tested(condition)
        self.activities(activities, above)
        self.code.add(JUMP, start)
        self._mark(done)

    def _semaphore(self, access: SemaphoreAccess, above: tuple[str, ...]) -> None:
        semaphore = self.resources.semaphores.get(access.semaphore)
        if semaphore is None:
            raise NotSimulatedError(f"the semaphore {access.semaphore!r} is not defined in the model")
        if access.operation is SemaphoreOperation.RELEASE:
            self.code.add(UNLOCK, semaphore)
            self._observe(SemaphoreEvent, access.semaphore, SemaphoreChange.UNLOCK, above)
            return
        flags = EXCLUSIVE if access.operation is SemaphoreOperation.EXCLUSIVE else 0
        if waits_actively(access, spinlocks_of(self.resources.context.system)):
            flags |= ACTIVE
        self.code.add(REQUEST, semaphore, flags)
        self._observe(SemaphoreEvent, access.semaphore, SemaphoreChange.LOCK, above)

    def _stimulus(self, name: str) -> int:
        if name not in self.owner.stimuli:
            raise NotSimulatedError(f"the stimulus {name!r} is not defined in the model")
        return self.owner.stimuli[name]

    def _os_events(self, activity: SetEvent | ClearEvent | WaitEvent) -> None:
        operation = {SetEvent: SET_EVENT, ClearEvent: CLEAR_EVENT, WaitEvent: WAIT_EVENT}[type(activity)]
        self.code.add(operation, self.resources.event_row(activity, self.owner.processes))

    def _mode(self, access: ModeAccess) -> None:
        if access.operation is ModeOperation.READ:
            return
        label = self.owner.modes.label(access.label)
        if access.operation is ModeOperation.SET:
            if access.value is None:
                raise NotSimulatedError(f"it sets the mode label {access.label!r} to nothing")
            self.code.add(SET_MODE, label, self.owner.modes.value(access.label, access.value))
        else:
            self.code.add(STEP_MODE, label, access.step if access.operation is ModeOperation.INCREMENT else -access.step)

    def _server_call(self, call: ServerCall) -> None:
        waits = call.waits and call.kind is not ServerCallKind.ASYNCHRONOUS
        if not waits:
            self._check(call)
        elif call.runnable not in self.resources.executing:
            raise NotSimulatedError(f"it waits for the server runnable {call.runnable!r}, which no process executes")
        # Where a model does not state it, a client waits actively, as for INCHRON's importer.
        flags = 0 if call.waiting is Waiting.PASSIVE else ACTIVE
        service = self.resources.services.get(call.runnable, 0)
        if call.kind is not ServerCallKind.GET_RESULT and service:
            self.code.add(ASK, service)
        if waits:
            self.code.add(AWAIT, service, flags)

    def _check(self, activity: ServerCall | SenderReceiverAccess) -> None:
        """Refuse runnables that are to be executed, but that no process executes."""
        reason = obstacle(activity, self.resources.executing)
        if reason:
            raise NotSimulatedError(reason)


def _too_many_activities() -> NotSimulatedError:
    return NotSimulatedError(f"it executes more than {MAX_OPERATIONS:,} activities")
