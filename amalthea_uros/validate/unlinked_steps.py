"""Steps of event chains between whose events nothing takes the effect on."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

from amalthea_uros.perf.named import Located
from amalthea_uros.timing.dataflow.chains import steps
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.routes import routes
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
    """All of them; events of which it is unknown where they occur do not count."""
    system = context.system
    for chain in system.events.chains:
        for item, starts, ends in steps(chain, system):
            for first, then in product(starts, ends):
                if first != then and not _is_linked(first, then, context):
                    yield UnlinkedStep(chain.name, item, first, then)


def _is_linked(first: str, then: str, context: SystemContext) -> bool:
    events = [context.system.events_by_name[name] for name in (first, then) if name in context.system.events_by_name]
    try:
        return len(events) < 2 or routes(events, context.dataflow)[0].gaps == 0
    except UnresolvedError:
        return True
