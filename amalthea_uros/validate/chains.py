"""The parts and the ends of event chains."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.metamodel import classes as am


def parts(chain: am.AbstractEventChain) -> list[am.AbstractEventChain]:
    """The chains of the items of a chain; items without a chain are skipped."""
    items = (item for item in chain.items if isinstance(item, am.EventChainContainer | am.EventChainReference))
    return [item.event_chain for item in items if item.event_chain is not None]


def ends(chain: am.AbstractEventChain) -> tuple[am.Event | None, am.Event | None]:
    """The stimulus and the response of a chain."""
    return chain.stimulus, chain.response


def events(end: am.Event | None) -> Sequence[am.Event]:
    """The events of an end of a chain: all events of a set, or the event itself."""
    if isinstance(end, am.EventSet):
        return end.events
    return (end,) if end is not None else ()
