"""The events and event chains that am2inc converts."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.metamodel.classes import (
    AbstractEventChain,
    Event,
    EventChain,
    EventSet,
    LabelEvent,
    ProcessEvent,
    RunnableEvent,
    Task,
)
from amalthea_uros.validate.chains import ends, events, parts
from amalthea_uros.validate.context import Context

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


def is_parallel(chain: AbstractEventChain) -> bool:
    """Whether am2inc reads the items as parallel branches; a single item is read as a sequence."""
    return chain.item_type == "parallel" and len(chain.items) > 1


def events_read(chain: AbstractEventChain) -> Iterable[Event]:
    """The events that am2inc reads of a chain, each once: its ends unless it is a segment, and the stimuli of its later segments."""
    inner = [] if is_parallel(chain) else [part.stimulus for part in parts(chain)[1:]]
    read = [*ends(chain), *inner] if isinstance(chain, EventChain) else inner
    return dict.fromkeys(event for end in read for event in events(end) if event.unresolved is None)


def dropped(context: Context) -> set[AbstractEventChain]:
    """The chains that are not converted."""
    holders: dict[AbstractEventChain, list[AbstractEventChain]] = {}
    for chain in context.all(AbstractEventChain):
        for part in parts(chain):
            holders.setdefault(part, []).append(chain)
    found: set[AbstractEventChain] = set()
    pending = [chain for chain in context.all(AbstractEventChain) if _is_refused(chain)]
    while pending:
        chain = pending.pop()
        if chain not in found:
            found.add(chain)
            pending += holders.get(chain, [])
    return found | {chain for chain in context.all(EventChain) if not all(map(_is_end, ends(chain)))}


def _is_refused(chain: AbstractEventChain) -> bool:
    """Whether something inside a chain prevents its conversion, and that of every chain of which it is a part."""
    if not chain.items:
        return None in ends(chain)
    if any(part.unresolved is not None for part in parts(chain)):
        return True
    if is_parallel(chain):
        return any(ends(branch) != ends(chain) for branch in parts(chain))
    return not all(part.stimulus is not None and is_converted(part.stimulus) for part in parts(chain)[1:])


def _is_end(event: Event | None) -> bool:
    return event is not None and is_converted(event) and not (isinstance(event, EventSet) and len(event.events) > 1)
