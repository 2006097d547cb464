"""Programs of processes: their activities, in the order in which jobs reach them, as operations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    ClearEvent,
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
from amalthea_uros.perf.os import Scheduler
from amalthea_uros.perf.software import Isr, Preemption, Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.simulate.layout import (
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
    CHOOSE,
    CLEAR_EVENT,
    COUNT,
    DRAW,
    END,
    EXCLUSIVE,
    EXECUTE,
    FIRE,
    JUMP,
    MASK,
    NEXT,
    NOTE,
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
    UNLOCK,
    UNMASK,
    WAIT_EVENT,
)
from amalthea_uros.simulate.options import Mode
from amalthea_uros.simulate.program.code import Argument, Code, Label, Table
from amalthea_uros.simulate.program.modes import Modes
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.simulate.program.resources import Resources, constant
from amalthea_uros.simulate.sampling.streams import Stream
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


@dataclass(slots=True)
class Hooks:
    """What chains and event stimuli add to the program of a process: at its start and end, and before and after its activities."""

    start: list[Operation] = field(default_factory=list)
    end: list[Operation] = field(default_factory=list)
    before: dict[int, list[Operation]] = field(default_factory=dict)
    after: dict[int, list[Operation]] = field(default_factory=dict)


@dataclass(slots=True)
class BodyCompiler:
    """Makes programs of processes.

    Attributes
    ----------
    processes, stimuli : their records
    is_noted : whether events of runnables and labels are recorded
    """

    resources: Resources
    modes: Modes
    processes: dict[str, int]
    stimuli: dict[str, int]
    is_noted: bool

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
    masks: int = 0

    @property
    def resources(self) -> Resources:
        return self.owner.resources

    @property
    def place(self) -> str:
        """What draws values here: the random numbers of one place do not depend on others."""
        name = self.process.name if self.process is not None else f"decision on {self.core}"
        return f"{name} activity {self.number} {len(self.code.operations)}"

    def compile(self, scheduler: Scheduler | None) -> Code:
        process, model = self.process, self.resources.context.demand_model
        assert process is not None
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
            self._execute(self.resources.ticks(ticks, self.core, Fraction(1), self.place))

    def _frame(self, frame: Frame) -> None:
        self._execute(self.resources.frame(frame, self.core, self.place))

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
                raise NotSimulatedError(f"it executes more than {MAX_OPERATIONS:,} activities")
            skip = self._counted(activity, activity.counter) if isinstance(activity, Call) else None
            self._add_all(self.hooks.before.get(number, ()))
            for demand in self.resources.context.demand_model.overheads.of_activity(activity, self.core):
                self._demand(demand)
            self._activity(activity, above)
            self._add_all(self.hooks.after.get(number, ()))
            if isinstance(activity, Call):
                self._return()
            self._mark(skip)

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
                    self._execute(self.resources.ticks(need, self.core, factor, f"{self.place} {name}"))
            case LabelAccess(label=label, kind=kind, times=times):
                self._access(label, kind, times)
                self._note_access(label, kind)
            case SenderReceiverAccess(label=label, kind=kind):
                self._check(activity)
                self._access(label, kind, None)
                self._note_access(label, kind)
            case Send(channel=channel, elements=elements):
                self._access(channel, AccessKind.WRITE, max(1, elements))
                self.code.add(SEND, self.owner.modes.channel(channel), elements)
            case Receive():
                self._receive(activity)
            case Call():
                self._call(activity, above)
            case Group():
                self._group(activity, above)
            case ProbabilitySwitch():
                self._choose(activity, above)
            case Switch():
                self._switch(activity, above)
            case Loop(activities=inner, condition=condition):
                self._loop(inner, condition, above)
            case SemaphoreAccess():
                self._semaphore(activity)
            case Trigger(stimulus=stimulus):
                skip = self._counted(activity, activity.counter)
                self.code.add(FIRE, self._stimulus(stimulus))
                self._mark(skip)
            case SetEvent() | ClearEvent() | WaitEvent():
                self._os_events(activity)
            case ModeAccess():
                self._mode(activity)
            case ServerCall():
                self._server_call(activity)
            case SchedulePoint():
                self.code.add(POINT)
            case Terminate():
                skip = self._counted(activity, activity.counter)
                for _ in range(self.masks):
                    self.code.add(UNMASK)
                self.code.add(JUMP, self.end)
                self._mark(skip)
            case RaiseEvent():
                pass  # what it activates is among the hooks
            case Migrate():
                raise NotSimulatedError("it migrates to another scheduler, which is not simulated")
            case Incomplete(reason=reason, is_access=is_access):
                if not is_access or self.resources.context.settings.memory is not Memory.NONE:
                    raise NotSimulatedError(f"it contains {reason}")

    def _counted(self, owner: Activity, counter: Counter | None) -> Label | None:
        """A label to which a job goes if a counter does not let this time take effect."""
        place = self.resources.counter(owner, counter)
        if not place:
            return None
        label = Label()
        self.code.add(COUNT, place, label)
        return label

    def _mark(self, label: Label | None) -> None:
        if label is not None:
            self.code.mark(label)

    def _note_access(self, label: str, kind: AccessKind) -> None:
        if self.owner.is_noted and label in self.resources.context.system.labels:
            event = EventKind.READ if kind is AccessKind.READ else EventKind.WRITE
            self.code.add(NOTE, int(event), self.resources.entities.number(EntityKind.LABEL, label))

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
        again, done = self._repeated(call)
        skip_inner = self._tested(runnable.condition)
        service = self.resources.services.get(runnable.name, 0)
        self._note(EventKind.RUNNABLE_START, runnable.name)
        if service:
            self.code.add(SERVE, service)
        self.activities(runnable.activities, (*above, runnable.name))
        if service:
            self.code.add(SERVED, service)
        self._note(EventKind.RUNNABLE_TERMINATE, runnable.name)
        self._mark(skip_inner)
        if again is not None:
            self.code.add(JUMP, again)
        self._mark(done)

    def _note(self, event: EventKind, runnable: str) -> None:
        if self.owner.is_noted:
            self.code.add(NOTE, int(event), self.resources.entities.number(EntityKind.RUNNABLE, runnable))

    def _repeated(self, call: Call) -> tuple[Label | None, Label | None]:
        """The begin and the end of a loop around what a call stands for, if it stands for several."""
        if call.times is None:
            return None, None
        least, mean, most = count_of(call.times)
        loop, done = self.resources.image.record(LOOP_SIZE), Label()
        passes = Statistics(lower=least, average=float(mean), upper=most)
        self.code.add(REPEAT, loop, self.resources.count(passes, f"{self.place} passes"))
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
        self.code.add(SHUFFLE, group, self.resources.order(f"{self.place} order"))
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
            self.code.add(CHOOSE, self.resources.choice(weights, f"{self.place} branch"), table)
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

    def _semaphore(self, access: SemaphoreAccess) -> None:
        semaphore = self.resources.semaphores.get(access.semaphore)
        if semaphore is None:
            raise NotSimulatedError(f"the semaphore {access.semaphore!r} is not defined in the model")
        if access.operation is SemaphoreOperation.RELEASE:
            self.code.add(UNLOCK, semaphore)
            return
        flags = EXCLUSIVE if access.operation is SemaphoreOperation.EXCLUSIVE else 0
        if waits_actively(access, spinlocks_of(self.resources.context.system)):
            flags |= ACTIVE
        self.code.add(REQUEST, semaphore, flags)

    def _stimulus(self, name: str) -> int:
        if name not in self.owner.stimuli:
            raise NotSimulatedError(f"the stimulus {name!r} is not defined in the model")
        return self.owner.stimuli[name]

    def _os_events(self, activity: SetEvent | ClearEvent | WaitEvent) -> None:
        skip = self._counted(activity, activity.counter)
        operation = {SetEvent: SET_EVENT, ClearEvent: CLEAR_EVENT, WaitEvent: WAIT_EVENT}[type(activity)]
        self.code.add(operation, self.resources.event_row(activity, self.owner.processes))
        self._mark(skip)

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
