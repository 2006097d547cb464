"""Semaphores, events of the operating system, and what activates others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.perf.activities import (
    ClearEvent,
    RaiseEvent,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    SetEvent,
    Trigger,
    WaitEvent,
)
from amalthea_uros.perf.events import CustomEvent, SemaphoreChange, SemaphoreEvent
from amalthea_uros.simulate.operations import (
    ACTIVE,
    CLEAR_EVENT,
    EXCLUSIVE,
    FIRE,
    POINT,
    REQUEST,
    SET_EVENT,
    UNLOCK,
    WAIT_EVENT,
)
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.timing.blocking.critical_sections import spinlocks_of, waits_actively

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body

_OPERATIONS = {SetEvent: SET_EVENT, ClearEvent: CLEAR_EVENT, WaitEvent: WAIT_EVENT}


def semaphore(body: Body, access: SemaphoreAccess) -> None:
    """A request or a release."""
    record = body.resources.semaphores.get(access.semaphore)
    if record is None:
        raise NotSimulatedError(f"the semaphore {access.semaphore!r} is not defined in the model")
    if access.operation is SemaphoreOperation.RELEASE:
        body.code.add(UNLOCK, record)
        body.observe(SemaphoreEvent, access.semaphore, SemaphoreChange.UNLOCK)
        return
    flags = EXCLUSIVE if access.operation is SemaphoreOperation.EXCLUSIVE else 0
    if waits_actively(access, spinlocks_of(body.context.system)):
        flags |= ACTIVE
    body.code.add(REQUEST, record, flags)
    body.observe(SemaphoreEvent, access.semaphore, SemaphoreChange.LOCK)


def os_events(body: Body, activity: SetEvent | ClearEvent | WaitEvent) -> None:
    """Events of the operating system that are set, cleared or waited for."""
    body.code.add(_OPERATIONS[type(activity)], body.resources.event_row(activity, body.parts.processes))


def trigger(body: Body, activity: Trigger) -> None:
    """An occurrence of a stimulus."""
    if activity.stimulus not in body.parts.stimuli:
        raise NotSimulatedError(f"the stimulus {activity.stimulus!r} is not defined in the model")
    body.code.add(FIRE, body.parts.stimuli[activity.stimulus])


def raise_event(body: Body, activity: RaiseEvent) -> None:
    """An event of the model; what it activates is among the hooks."""
    body.observe(CustomEvent, activity.event)


def schedule_point(body: Body, activity: SchedulePoint) -> None:
    """Where other tasks can go first."""
    body.code.add(POINT)
