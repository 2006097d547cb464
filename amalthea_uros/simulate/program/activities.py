"""What each kind of activity is in the program of a process."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    ClearEvent,
    Communication,
    Count,
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
from amalthea_uros.perf.distributions import Statistics
from amalthea_uros.perf.events import (
    ChannelChange,
    ChannelEvent,
    CustomEvent,
    LabelChange,
    LabelEvent,
    ModeChange,
    ModeLabelEvent,
    RunnableChange,
    RunnableEvent,
    SemaphoreChange,
    SemaphoreEvent,
)
from amalthea_uros.perf.network import Purpose
from amalthea_uros.perf.software import Runnable
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.image import JumpLabel, JumpTable
from amalthea_uros.timing.basics.settings import MemoryModel
from amalthea_uros.timing.blocking.critical_sections import spinlocks_of, waits_actively
from amalthea_uros.timing.jobs.executed import MAX_CALL_DEPTH, count_of, obstacle
from amalthea_uros.trace.table import EntityKind, EventKind

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body


def compile_activity(body: Body, activity: Activity) -> None:
    """Append the operations of one activity.

    Raises
    ------
    UnknownError : it cannot be simulated, or a demand in it is not known.
    """
    _COMPILERS[type(activity)](body, activity)


# Calls of runnables, and of those that other processes execute.


def call(body: Body, activity: Call) -> None:
    """The activities of a runnable, as often as it is called; it starts and ends each time."""
    runnable = _callable(body, activity)
    number = body.number
    again, done = _repeated(body, activity)
    skip = body.tested(runnable.condition) if activity.times is not None else None
    body.add_all(body.hooks.before.get(number, ()))
    _execution(body, runnable)
    body.add_all(body.hooks.after.get(number, ()))
    body.mark(skip)
    if again is not None:
        body.code.add(layout.JUMP, again)
    body.mark(done)


def _callable(body: Body, activity: Call) -> Runnable:
    runnable = body.context.system.runnables.get(activity.runnable)
    if runnable is None:
        raise UnknownError(f"the runnable {activity.runnable!r} is not defined in the model")
    if runnable.name in body.above:
        raise UnknownError(f"the runnable {runnable.name!r} calls itself")
    if len(body.above) > MAX_CALL_DEPTH:
        raise UnknownError(f"calls are nested deeper than {MAX_CALL_DEPTH} levels")
    return runnable


def _repeated(body: Body, activity: Call) -> tuple[JumpLabel | None, JumpLabel | None]:
    """The begin and the end of a loop around what a call stands for, if it stands for several."""
    if activity.times is None:
        return None, None
    least, mean, most = count_of(activity.times)
    record, done = body.resources.image.record(layout.LOOP_SIZE), JumpLabel()
    passes = Statistics(lower=least, average=float(mean), upper=most)
    body.code.add(layout.REPEAT, record, body.resources.count(passes, f"{body.place()} passes"))
    again = body.code.here()
    body.code.add(layout.AGAIN, record, done)
    return again, done


def _execution(body: Body, runnable: Runnable) -> None:
    """One execution, between what reports its start and its end."""
    service = body.resources.services.get(runnable.name, 0)
    site = body.resources.site(runnable.name) if body.resources.is_noted else 0
    measured = _measured(body, runnable.name)
    if site:
        body.code.add(layout.BEGIN_RUNNABLE, site)
    if measured:
        body.code.add(layout.BEGIN_EXECUTION, measured)
    body.observe(RunnableEvent, runnable.name, RunnableChange.START)
    if service:
        body.code.add(layout.SERVE, service)
    outer, body.above = body.above, (*body.above, runnable.name)
    body.activities(runnable.activities)
    body.above = outer
    if service:
        body.code.add(layout.ANSWER, service)
    body.observe(RunnableEvent, runnable.name, RunnableChange.TERMINATE)
    if measured:
        body.code.add(layout.END_EXECUTION, measured)
    if site:
        body.code.add(layout.END_RUNNABLE, site)


def _measured(body: Body, runnable: str) -> int:
    """The record of the executions of a runnable in this process, if they are measured, or 0."""
    number = body.resources.watches.measured.get(runnable)
    if number is None:
        return 0
    if runnable not in body.executions:
        body.executions[runnable] = body.resources.image.record(layout.EXECUTION_SIZE, {layout.EXECUTION_NUMBER: number})
    return body.executions[runnable]


def server_call(body: Body, activity: ServerCall) -> None:
    """A request to another process, and waiting for its end."""
    waits = activity.waits and activity.kind is not ServerCallKind.ASYNCHRONOUS
    if not waits:
        check_executing(body, activity)
    elif activity.runnable not in body.resources.executing:
        raise UnknownError(f"it waits for the server runnable {activity.runnable!r}, which no process executes")
    # Where a model does not state it, a client waits actively, as for INCHRON's importer.
    flags = 0 if activity.waiting is Waiting.PASSIVE else layout.ACTIVE
    service = body.resources.services.get(activity.runnable, 0)
    if activity.kind is not ServerCallKind.GET_RESULT and service:
        body.code.add(layout.ASK, service)
    if waits:
        body.code.add(layout.AWAIT, service, flags)


def check_executing(body: Body, activity: ServerCall | SenderReceiverAccess) -> None:
    """Refuse runnables that are to be executed, but that no process executes.

    Raises
    ------
    UnknownError : there is one.
    """
    reason = obstacle(activity, body.resources.executing)
    if reason:
        raise UnknownError(reason)


# Groups, branches and loops.


def group(body: Body, activity: Group) -> None:
    """Activities one after the other, or in any order; perhaps without interruption."""
    if not activity.interruptible:
        body.code.add(layout.MASK)
        body.masks += 1
    if activity.ordered or len(activity.activities) < 2 or body.resources.options.mode is not SimulationMode.SAMPLED:
        body.activities(activity.activities)
    else:
        _in_any_order(body, activity.activities)
    if not activity.interruptible:
        body.code.add(layout.UNMASK)
        body.masks -= 1


def _in_any_order(body: Body, activities: Sequence[Activity]) -> None:
    image, total, done = body.resources.image, len(activities), JumpLabel()
    ordered, _ = image.items([0] * total)
    parts, _ = image.items([0] * total)
    record = image.record(layout.GROUP_SIZE, {layout.ORDERED_PARTS: ordered, layout.PARTS: parts, layout.PARTS_TOTAL: total})
    body.code.add(layout.SHUFFLE, record, body.resources.order(f"{body.place()} order"))
    following = body.code.here()
    body.code.add(layout.NEXT, record, done)
    labels = []
    for activity in activities:
        labels.append(body.code.here())
        body.activities([activity])
        body.code.add(layout.JUMP, following)
    body.code.tables.append(JumpTable(labels, ordered))
    body.code.mark(done)


def choose(body: Body, activity: ProbabilitySwitch) -> None:
    """One of several branches: drawn, or that with the longest or shortest demand."""
    if not activity.branches:
        return
    table, _ = body.resources.image.items([0] * len(activity.branches))
    labels, done, jump = [], JumpLabel(), JumpLabel()
    only = _extreme_branch(body, activity)
    if only is not None:
        body.code.add(layout.JUMP, jump)
    else:
        weights = [branch.weight for branch in activity.branches]
        body.code.add(layout.CHOOSE, body.resources.choice(weights, f"{body.place()} branch"), table)
    for index, branch in enumerate(activity.branches):
        labels.append(body.code.here())
        if index == only:
            body.code.mark(jump)
        body.activities(branch.activities)
        body.code.add(layout.JUMP, done)
    body.code.tables.append(JumpTable(labels, table))
    body.code.mark(done)


def _extreme_branch(body: Body, switch: ProbabilitySwitch) -> int | None:
    """The branch with the longest demand in the worst case, or with the shortest one in the best; else None."""
    mode, process = body.resources.options.mode, body.process
    if mode not in (SimulationMode.WORST, SimulationMode.BEST) or process is None:
        return None
    weights = [branch.weight for branch in switch.branches]
    possible = [index for index, weight in enumerate(weights) if weight or not any(weights)]
    model = body.context.demand_model
    demands = {index: model.of_activities(process, switch.branches[index].activities, body.core) for index in possible}
    if mode is SimulationMode.WORST:
        return max(possible, key=lambda index: demands[index].worst)
    return min(possible, key=lambda index: demands[index].best)


def switch(body: Body, activity: Switch) -> None:
    """The first case whose condition is true, or the default."""
    done = JumpLabel()
    for case in activity.cases:
        if case.condition is None:
            raise UnknownError("a branch of a switch has no condition")
        following = body.tested(case.condition)
        body.activities(case.activities)
        body.code.add(layout.JUMP, done)
        body.mark(following)
    body.activities(activity.default or ())
    body.code.mark(done)


def loop(body: Body, activity: Loop) -> None:
    """Activities as long as a condition is true."""
    if activity.condition is None:
        raise UnknownError("a loop has no condition")
    start = body.code.here()
    done = body.tested(activity.condition)
    body.activities(activity.activities)
    body.code.add(layout.JUMP, start)
    body.mark(done)


def terminate(body: Body, activity: Terminate) -> None:
    """The end of the job, also within groups that cannot be interrupted."""
    for _ in range(body.masks):
        body.code.add(layout.UNMASK)
    body.code.add(layout.JUMP, body.end)


# Accesses to labels, channels and mode labels.

_MODE_CHANGES = {
    ModeOperation.READ: ModeChange.READ,
    ModeOperation.SET: ModeChange.WRITE,
    ModeOperation.INCREMENT: ModeChange.INCREMENT,
    ModeOperation.DECREMENT: ModeChange.DECREMENT,
}


def label_access(body: Body, access: LabelAccess) -> None:
    """An access to a label, with its time."""
    _access_label(body, access.label, access.kind, access.times, access.communication)


def sender_receiver_access(body: Body, access: SenderReceiverAccess) -> None:
    """An access to a label that has runnables to be notified."""
    check_executing(body, access)
    _access_label(body, access.label, access.kind)


def _access_label(
    body: Body, label: str, kind: AccessKind, times: Count | float | None = None, communication: Communication | None = None
) -> None:
    body.access(label, kind, times)
    # In traces, schedulers do not access labels.
    if body.resources.is_noted and body.process is not None and label in body.context.system.labels:
        event = EventKind.READ if kind is AccessKind.READ else EventKind.WRITE
        body.code.add(layout.NOTE, int(event), body.resources.entities.number(EntityKind.LABEL, label))
    body.observe(LabelEvent, label, LabelChange(kind), communication)


def send(body: Body, activity: Send) -> None:
    """Elements to a channel."""
    body.access(activity.channel, AccessKind.WRITE, max(1, activity.elements))
    body.code.add(layout.SEND, body.resources.modes.channel(activity.channel), activity.elements)
    body.observe(ChannelEvent, activity.channel, ChannelChange.SEND)


def receive(body: Body, activity: Receive) -> None:
    """Elements from a channel."""
    most = max(1, activity.elements)
    least = min(activity.at_least, most)
    body.access(activity.channel, AccessKind.READ, Count(least=least, mean=most, most=most))
    takes = activity.operation is not None and "take" in activity.operation
    body.code.add(layout.RECEIVE, body.resources.modes.channel(activity.channel), activity.elements if takes else 0)
    body.observe(ChannelEvent, activity.channel, ChannelChange.RECEIVE)


def mode_access(body: Body, access: ModeAccess) -> None:
    """A change of a mode label, or reading it, which takes no time."""
    if access.operation is not ModeOperation.READ:
        _change_mode(body, access)
    body.observe(ModeLabelEvent, access.label, _MODE_CHANGES[access.operation])


def _change_mode(body: Body, access: ModeAccess) -> None:
    label = body.resources.modes.label(access.label)
    if access.operation is ModeOperation.SET:
        if access.value is None:
            raise UnknownError(f"it sets the mode label {access.label!r} to nothing")
        body.code.add(layout.SET_MODE, label, body.resources.modes.value(access.label, access.value))
    else:
        body.code.add(layout.STEP_MODE, label, access.step if access.operation is ModeOperation.INCREMENT else -access.step)


# Semaphores, events of the operating system, and what activates others.

_OPERATIONS = {SetEvent: layout.SET_EVENT, ClearEvent: layout.CLEAR_EVENT, WaitEvent: layout.WAIT_EVENT}


def semaphore(body: Body, access: SemaphoreAccess) -> None:
    """A request or a release."""
    record = body.resources.semaphores.get(access.semaphore)
    if record is None:
        raise UnknownError(f"the semaphore {access.semaphore!r} is not defined in the model")
    if access.operation is SemaphoreOperation.RELEASE:
        body.code.add(layout.UNLOCK, record)
        body.observe(SemaphoreEvent, access.semaphore, SemaphoreChange.UNLOCK)
        return
    flags = layout.EXCLUSIVE if access.operation is SemaphoreOperation.EXCLUSIVE else 0
    if waits_actively(access, spinlocks_of(body.context.system)):
        flags |= layout.ACTIVE
    body.code.add(layout.REQUEST, record, flags)
    body.observe(SemaphoreEvent, access.semaphore, SemaphoreChange.LOCK)


def os_events(body: Body, activity: SetEvent | ClearEvent | WaitEvent) -> None:
    """Events of the operating system that are set, cleared or waited for."""
    body.code.add(_OPERATIONS[type(activity)], body.resources.event_row(activity))


def trigger(body: Body, activity: Trigger) -> None:
    """An occurrence of a stimulus."""
    if activity.stimulus not in body.resources.stimuli:
        raise UnknownError(f"the stimulus {activity.stimulus!r} is not defined in the model")
    if not _handles_message(body, activity.stimulus):
        is_received = body.process is not None and body.process.name in body.resources.executors.messages.receivers
        body.code.add(layout.FIRE, body.resources.stimuli[activity.stimulus], int(is_received))


def _handles_message(body: Body, stimulus: str) -> bool:
    """Send the message that a stimulus stands for, or have it continue; False if it stands for none."""
    messages, process = body.resources.executors.messages, "" if body.process is None else body.process.name
    own, sent = messages.system.transmissions.get(process), messages.sent.get(stimulus)
    if own is not None and process in messages.transmissions:
        if sent is not None and sent.name in messages.acknowledging_lines:
            body.part += 1
            body.code.add(layout.PART_ARRIVES, messages.acknowledging_lines[sent.name], body.part)
            return True
        # What it passes first gets it after the time in the driver.
        return stimulus == messages.receiving_stimulus(own)
    if sent is None:
        return False
    if body.iteration is None:
        body.code.add(layout.POST, messages.transmissions[sent.name])
    elif sent.purpose is not Purpose.ACKNOWLEDGEMENT:
        # It acknowledges what it reads when it reads it.
        body.iteration.publish(sent.name)
    return True


def raise_event(body: Body, activity: RaiseEvent) -> None:
    """An event of the model; what it activates is among the hooks."""
    body.observe(CustomEvent, activity.event)


def schedule_point(body: Body, activity: SchedulePoint) -> None:
    """Where other tasks can go first."""
    body.code.add(layout.POINT)


def execute(body: Body, activity: Execute) -> None:
    """Ticks or time."""
    body.demand(activity.demand)


def execution_need(body: Body, activity: ExecutionNeed) -> None:
    """Needs, one after the other."""
    for name, need in activity.needs:
        factor = body.context.demand_model.ticks_per_unit(name, body.core)
        body.execute(body.resources.ticks(need, body.core, factor, f"{body.place()} {name}"))


def incomplete(body: Body, activity: Incomplete) -> None:
    """Refuse what the model does not state, unless it is an access that takes no time."""
    if not activity.is_access or body.context.settings.memory is not MemoryModel.NONE:
        raise UnknownError(f"it contains {activity.reason}")


def migrate(body: Body, activity: Migrate) -> None:
    """Refuse what goes to another scheduler."""
    raise UnknownError("it migrates to another scheduler, which is not simulated")


_COMPILERS: Mapping[type[Activity], Callable[[Body, Any], None]] = MappingProxyType(
    {
        Call: call,
        ClearEvent: os_events,
        Execute: execute,
        ExecutionNeed: execution_need,
        Group: group,
        Incomplete: incomplete,
        LabelAccess: label_access,
        Loop: loop,
        Migrate: migrate,
        ModeAccess: mode_access,
        ProbabilitySwitch: choose,
        RaiseEvent: raise_event,
        Receive: receive,
        SchedulePoint: schedule_point,
        SemaphoreAccess: semaphore,
        Send: send,
        SenderReceiverAccess: sender_receiver_access,
        ServerCall: server_call,
        SetEvent: os_events,
        Switch: switch,
        Terminate: terminate,
        Trigger: trigger,
        WaitEvent: os_events,
    }
)
