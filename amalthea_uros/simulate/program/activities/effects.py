"""Accesses to labels, channels, mode labels, semaphores and OS events, what activates others, and what takes time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import (
    AccessKind,
    ClearEvent,
    Communication,
    Count,
    Execute,
    ExecutionNeed,
    Incomplete,
    LabelAccess,
    ModeAccess,
    ModeOperation,
    RaiseEvent,
    Receive,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    Send,
    SenderReceiverAccess,
    SetEvent,
    Trigger,
    WaitEvent,
)
from amalthea_uros.perf.events import (
    ChannelChange,
    ChannelEvent,
    CustomEvent,
    LabelChange,
    LabelEvent,
    ModeChange,
    ModeLabelEvent,
    SemaphoreChange,
    SemaphoreEvent,
)
from amalthea_uros.simulate.kernel import operations
from amalthea_uros.simulate.program.activities.calls import check_executing
from amalthea_uros.timing.basics.settings import MemoryModel
from amalthea_uros.timing.blocking.critical_sections import spinlocks_of, waits_actively
from amalthea_uros.trace.table import EntityKind, EventKind

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body

_MODE_CHANGES = {
    ModeOperation.READ: ModeChange.READ,
    ModeOperation.SET: ModeChange.WRITE,
    ModeOperation.INCREMENT: ModeChange.INCREMENT,
    ModeOperation.DECREMENT: ModeChange.DECREMENT,
}


def label_access(body: Body, access: LabelAccess) -> None:
    """An access to a label, with its time."""
    body.access(access.label, access.kind, access.times)
    _label_accessed(body, access.label, access.kind, access.communication)


def sender_receiver_access(body: Body, access: SenderReceiverAccess) -> None:
    """An access to a label that has runnables to be notified."""
    check_executing(body, access)
    body.access(access.label, access.kind, None)
    _label_accessed(body, access.label, access.kind, None)


def _label_accessed(body: Body, label: str, kind: AccessKind, communication: Communication | None) -> None:
    # In traces, schedulers do not access labels.
    if body.parts.is_noted and body.process is not None and label in body.context.system.labels:
        event = EventKind.READ if kind is AccessKind.READ else EventKind.WRITE
        body.code.add(operations.NOTE, int(event), body.resources.entities.number(EntityKind.LABEL, label))
    body.observe(LabelEvent, label, LabelChange(kind), communication)


def send(body: Body, activity: Send) -> None:
    """Elements to a channel."""
    body.access(activity.channel, AccessKind.WRITE, max(1, activity.elements))
    body.code.add(operations.SEND, body.parts.modes.channel(activity.channel), activity.elements)
    body.observe(ChannelEvent, activity.channel, ChannelChange.SEND)


def receive(body: Body, activity: Receive) -> None:
    """Elements from a channel."""
    most = max(1, activity.elements)
    least = min(activity.at_least, most)
    body.access(activity.channel, AccessKind.READ, Count(least=least, mean=most, most=most))
    takes = activity.operation is not None and "take" in activity.operation
    body.code.add(operations.RECEIVE, body.parts.modes.channel(activity.channel), activity.elements if takes else 0)
    body.observe(ChannelEvent, activity.channel, ChannelChange.RECEIVE)


def mode_access(body: Body, access: ModeAccess) -> None:
    """A change of a mode label, or reading it, which takes no time."""
    if access.operation is not ModeOperation.READ:
        _change_mode(body, access)
    body.observe(ModeLabelEvent, access.label, _MODE_CHANGES[access.operation])


def _change_mode(body: Body, access: ModeAccess) -> None:
    label = body.parts.modes.label(access.label)
    if access.operation is ModeOperation.SET:
        if access.value is None:
            raise UnknownError(f"it sets the mode label {access.label!r} to nothing")
        body.code.add(operations.SET_MODE, label, body.parts.modes.value(access.label, access.value))
    else:
        body.code.add(operations.STEP_MODE, label, access.step if access.operation is ModeOperation.INCREMENT else -access.step)


# Semaphores, events of the operating system, and what activates others.

_OPERATIONS = {SetEvent: operations.SET_EVENT, ClearEvent: operations.CLEAR_EVENT, WaitEvent: operations.WAIT_EVENT}


def semaphore(body: Body, access: SemaphoreAccess) -> None:
    """A request or a release."""
    record = body.resources.semaphores.get(access.semaphore)
    if record is None:
        raise UnknownError(f"the semaphore {access.semaphore!r} is not defined in the model")
    if access.operation is SemaphoreOperation.RELEASE:
        body.code.add(operations.UNLOCK, record)
        body.observe(SemaphoreEvent, access.semaphore, SemaphoreChange.UNLOCK)
        return
    flags = operations.EXCLUSIVE if access.operation is SemaphoreOperation.EXCLUSIVE else 0
    if waits_actively(access, spinlocks_of(body.context.system)):
        flags |= operations.ACTIVE
    body.code.add(operations.REQUEST, record, flags)
    body.observe(SemaphoreEvent, access.semaphore, SemaphoreChange.LOCK)


def os_events(body: Body, activity: SetEvent | ClearEvent | WaitEvent) -> None:
    """Events of the operating system that are set, cleared or waited for."""
    body.code.add(_OPERATIONS[type(activity)], body.resources.event_row(activity, body.parts.processes))


def trigger(body: Body, activity: Trigger) -> None:
    """An occurrence of a stimulus."""
    if activity.stimulus not in body.parts.stimuli:
        raise UnknownError(f"the stimulus {activity.stimulus!r} is not defined in the model")
    body.code.add(operations.FIRE, body.parts.stimuli[activity.stimulus])


def raise_event(body: Body, activity: RaiseEvent) -> None:
    """An event of the model; what it activates is among the hooks."""
    body.observe(CustomEvent, activity.event)


def schedule_point(body: Body, activity: SchedulePoint) -> None:
    """Where other tasks can go first."""
    body.code.add(operations.POINT)


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
