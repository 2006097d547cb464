"""The events that am2inc converts."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import Event, EventSet, LabelEvent, ProcessEvent, RunnableEvent, Task

#: The classes of events that am2inc converts.
CONVERTED = (ProcessEvent, RunnableEvent, LabelEvent)

_OF_PROCESSES = frozenset({"activate", "start", "terminate"})


def moments(event: Event) -> frozenset[str]:
    """The types that am2inc converts for an event."""
    match event:
        case RunnableEvent():
            return frozenset({"start", "terminate"})
        case LabelEvent():
            return frozenset({"read", "write"})
        case ProcessEvent(entity=Task()):
            return _OF_PROCESSES | {"resume", "wait", "release"}
        case ProcessEvent():
            return _OF_PROCESSES
    return frozenset()


def is_converted(event: Event) -> bool:
    """Whether am2inc converts an event, or all events of a set, as part of a chain."""
    if event.unresolved is not None:
        return False
    if isinstance(event, EventSet):
        return all(map(is_converted, event.events))
    if not isinstance(event, CONVERTED) or event.entity is None or event.entity.unresolved is not None:
        return False
    return event.event_type in moments(event)
