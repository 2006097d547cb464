"""Steps of event chains between whose events nothing takes the effect on."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

from amalthea_uros.perf.named import Located
from amalthea_uros.timing.dataflow.chains import steps
from amalthea_uros.timing.dataflow.routes import crosses, is_linked
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

    What a message passes between events on wires and in executors that loop, the analysis of its way says.
    """
    system, events = context.system, context.system.events_by_name
    for chain in system.events.chains:
        if crosses(chain, context.dataflow):
            continue
        for item, starts, ends in steps(chain, system):
            for first, then in product(starts, ends):
                is_known = first != then and first in events and then in events
                if is_known and not is_linked(events[first], events[then], context.dataflow):
                    yield UnlinkedStep(chain.name, item, first, then)
