"""The parts and the ends of event chains."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.metamodel.classes import AbstractEventChain, Event, EventChainContainer, EventChainReference, EventSet


def parts(chain: AbstractEventChain) -> list[AbstractEventChain]:
    """The chains of the items of a chain; items without a chain are skipped."""
    items = (item for item in chain.items if isinstance(item, EventChainContainer | EventChainReference))
    return [item.event_chain for item in items if item.event_chain is not None]


def ends(chain: AbstractEventChain) -> tuple[Event | None, Event | None]:
    """The stimulus and the response of a chain."""
    return chain.stimulus, chain.response


def events(end: Event | None) -> Sequence[Event]:
    """The events of an end of a chain: all events of a set, or the event itself."""
    if isinstance(end, EventSet):
        return end.events
    return (end,) if end is not None else ()
