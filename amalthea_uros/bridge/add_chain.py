"""Adding a chain to a model that was read, without modifying the rest of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.perf.events import Event, EventChain, ProcessChange, ProcessEvent, RunnableChange, RunnableEvent, Segment
from amalthea_uros.perf.events import Sequence as InSequence

T = TypeVar("T", bound=Element)

_PROCESS = {
    ProcessChange.START: am.ProcessEventType.START,
    ProcessChange.TERMINATE: am.ProcessEventType.TERMINATE,
}
_RUNNABLE = {
    RunnableChange.START: am.RunnableEventType.START,
    RunnableChange.TERMINATE: am.RunnableEventType.TERMINATE,
}


def add_chain(model: Model, chain: EventChain, events: Sequence[Event]) -> None:
    """Add a sequence of events of processes and runnables; existing events of the model are reused.

    Raises
    ------
    ValueError : the model already has a chain of that name, or a process or runnable of the chain has no name of its own.
    """
    if model.find(am.EventChain, chain.name) is not None:
        raise ValueError(f"the model already has a chain {chain.name!r}")
    root = model.root
    if root.event_model is None:
        root.event_model = am.EventModel()
    if root.constraints_model is None:
        root.constraints_model = am.ConstraintsModel()
    found: dict[str, am.Event] = {}
    for event in events:
        known = model.find(am.Event, event.name)
        if known is None:
            known = _event(model, event)
            root.event_model.events.append(known)
        found[event.name] = known
    made = am.EventChain(name=chain.name, stimulus=found[chain.stimulus or ""], response=found[chain.response or ""])
    if isinstance(chain.items, InSequence):
        made.item_type = am.EventChainItemType.SEQUENCE
        for item in chain.items.items:
            assert isinstance(item, Segment)
            part = am.SubEventChain(stimulus=found[item.stimulus or ""], response=found[item.response or ""])
            made.items.append(am.EventChainContainer(event_chain=part))
    root.constraints_model.event_chains.append(made)


def _event(model: Model, event: Event) -> am.Event:
    match event:
        case ProcessEvent(name=name, process=str(process), change=change) if change in _PROCESS:
            return am.ProcessEvent(name=name, entity=_named(model, am.Process, process), event_type=_PROCESS[change])
        case RunnableEvent(name=name, runnable=str(runnable), change=change, process=str(process)) if change in _RUNNABLE:
            return am.RunnableEvent(
                name=name,
                entity=_named(model, am.Runnable, runnable),
                event_type=_RUNNABLE[change],
                process=_named(model, am.Process, process),
            )
    raise AssertionError(f"not an event of a path: {event}")


def _named(model: Model, cls: type[T], name: str) -> T:
    """The object with a name. `extract` makes up names for objects without a unique one; those are not in the model."""
    found = model.find(cls, name)
    if found is None:
        raise ValueError(f"{name!r} has no name of its own in the model, so that a chain cannot refer to it; name it first")
    return found
