"""Steps of event chains between whose events nothing takes the effect on."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

from amalthea_uros.perf.events import Event, ProcessEvent
from amalthea_uros.perf.named import Located
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.chains import steps
from amalthea_uros.timing.dataflow.routes import is_linked
from amalthea_uros.validate.system_context import SystemContext


class UnlinkedStep(NamedTuple):
    """A step of a chain.

    Attributes
    ----------
    item : the chain or segment
    first, then : events
    """

    chain: str
    item: Located
    first: str
    then: str


def unlinked_steps(context: SystemContext) -> Iterator[UnlinkedStep]:
    """All of them; events of which it is unknown where they occur do not count.

    Neither do messages on wires: drivers and the middleware take them on, not the activities of processes. The analysis of ways tells
    where they get to.
    """
    system, events = context.system, context.system.events_by_name
    for chain in system.events.chains:
        for item, starts, ends in steps(chain, system):
            for first, then in product(starts, ends):
                is_known = first != then and first in events and then in events
                if not is_known or _is_message(events[first], system) or _is_message(events[then], system):
                    continue
                if not is_linked(events[first], events[then], context.dataflow):
                    yield UnlinkedStep(chain.name, item, first, then)


def _is_message(event: Event, system: System) -> bool:
    return isinstance(event, ProcessEvent) and event.process in system.transmissions
