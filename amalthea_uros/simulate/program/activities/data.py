"""Labels, channels and mode labels."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.perf.activities import (
    AccessKind,
    Communication,
    Count,
    LabelAccess,
    ModeAccess,
    ModeOperation,
    Receive,
    Send,
    SenderReceiverAccess,
)
from amalthea_uros.perf.events import ChannelChange, ChannelEvent, LabelChange, LabelEvent, ModeChange, ModeLabelEvent
from amalthea_uros.simulate.operations import NOTE, RECEIVE, SEND, SET_MODE, STEP_MODE
from amalthea_uros.simulate.program.activities.obstacles import check_executing
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
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
        body.code.add(NOTE, int(event), body.resources.entities.number(EntityKind.LABEL, label))
    body.observe(LabelEvent, label, LabelChange(kind), communication)


def send(body: Body, activity: Send) -> None:
    """Elements to a channel."""
    body.access(activity.channel, AccessKind.WRITE, max(1, activity.elements))
    body.code.add(SEND, body.parts.modes.channel(activity.channel), activity.elements)
    body.observe(ChannelEvent, activity.channel, ChannelChange.SEND)


def receive(body: Body, activity: Receive) -> None:
    """Elements from a channel."""
    most = max(1, activity.elements)
    least = min(activity.at_least, most)
    body.access(activity.channel, AccessKind.READ, Count(least=least, mean=most, most=most))
    takes = activity.operation is not None and "take" in activity.operation
    body.code.add(RECEIVE, body.parts.modes.channel(activity.channel), activity.elements if takes else 0)
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
            raise NotSimulatedError(f"it sets the mode label {access.label!r} to nothing")
        body.code.add(SET_MODE, label, body.parts.modes.value(access.label, access.value))
    else:
        body.code.add(STEP_MODE, label, access.step if access.operation is ModeOperation.INCREMENT else -access.step)
