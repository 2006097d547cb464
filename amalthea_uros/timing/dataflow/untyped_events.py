"""Events of chains that have no type: which moments of a job they may mean.

An event of a process or runnable without a type is not specified to be its activation, its start or its end. Which of these is the
worst one depends on the chain: mostly, the latency from an activation to a termination is the longest; but an event at the start of a
job comes before the data that it reads later, so that only the next job shows them. So each combination is a reading of the chain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

from amalthea_uros.perf.events import Event, ProcessChange, ProcessEvent, RunnableChange, RunnableEvent

ASSUMPTION = (
    "events of chains without a type are activations, starts or ends, whichever gives the longest latency: the bounds hold for each "
    "of these"
)

_OF_PROCESSES = (ProcessChange.ACTIVATE, ProcessChange.START, ProcessChange.TERMINATE)
_OF_RUNNABLES = (RunnableChange.START, RunnableChange.TERMINATE)


def is_untyped(event: Event) -> bool:
    """Whether an event of a process or runnable has no type."""
    return isinstance(event, ProcessEvent | RunnableEvent) and event.change is None


def readings(path: Sequence[Event]) -> list[tuple[Event, ...]]:
    """The sequences of events that a path through a chain may mean: its first, its last and all inner events have one type each."""
    if not any(map(is_untyped, path)):
        return [tuple(path)]
    return list(
        dict.fromkeys(
            (_typed(path[0], first), *(_typed(event, inner) for event in path[1:-1]), _typed(path[-1], last))
            for first, inner, last in product(range(len(_OF_PROCESSES)), repeat=3)
        )
    )


def _typed(event: Event, number: int) -> Event:
    """An event with one of the types that it may have."""
    match event:
        case ProcessEvent(change=None):
            return replace(event, change=_OF_PROCESSES[number])
        case RunnableEvent(change=None):
            return replace(event, change=_OF_RUNNABLES[min(number, 1)])
    return event
