"""The hops at tasks and interrupt service routines that are no executors that loop: the analysis of chains bounds them.

A chain over several controllers without a common clock is bounded by the sum of its parts (M. Günzel and others, RTAS 2021, theorem
5.8): the reduced reaction time of a part that is activated by the one before or starts the chain, and the full reaction time of one
that reads at its own times, as data can come just after a read. Executors and wires separate parts in the same way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.route_latencies import RouteLatencies
from amalthea_uros.analyze.chains.stage_timing import UnboundedStageError
from amalthea_uros.analyze.results.chains import Quantity, Value
from amalthea_uros.analyze.ways.stations import Passage
from amalthea_uros.executors.results import Hop, HopKind, Part
from amalthea_uros.perf.events import Event, ProcessChange, ProcessEvent
from amalthea_uros.timing.awaited import awaited
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.links import UNTIMED
from amalthea_uros.timing.dataflow.routes import routes
from amalthea_uros.units import Time


class Entry(Enum):
    """How a message or data get to a process."""

    FIRST = "the chain starts here"
    TRIGGER = "it is activated"
    DATA = "it reads data at its own times"
    POLLING = "it looks for messages in each job"


@dataclass(frozen=True, slots=True)
class PassageHops:
    """The hops at processes that the analysis of chains bounds."""

    evaluator: ChainEvaluator

    def hop(self, passage: Passage, entry: Entry, is_last: bool) -> Hop:
        """From the entry of a passage to its last event; if another hop follows, to the end of the job."""
        name = " -> ".join(dict.fromkeys(passage.processes))
        context = self.evaluator.context
        waiting = next(
            (each for process in passage.processes for each in awaited(process, context.system, context.dataflow)), None
        )
        if waiting is not None:
            return _unknown(
                entry,
                name,
                f"the response time of {name!r} does not include that it waits for the acknowledgement of {waiting.topic!r}",
                "Let an executor with a 'loop' run the callback, send with best effort, or set 'reliable: {waits: false}' if the port "
                "does not wait.",
            )
        try:
            times = self._bounds(_events(passage, entry, is_last), entry)
        except (UnboundedStageError, UnresolvedError) as error:
            return _unknown(entry, name, str(error), f"See the results of {name!r}.")
        if times is None:
            reason = f"the maximum time between two activations of {passage.processes[0]!r} is unknown"
            return _unknown(entry, name, reason, f"See the results of {passage.processes[0]!r}.")
        value, wait = times
        is_whole = is_last and entry is Entry.FIRST
        parts = (
            ()
            if not wait
            else (
                Part(name=f"until {passage.processes[0]} is activated", least=0, most=wait),
                Part(name=f"from its activation through {name}", least=0, most=value.value),
            )
        )
        return Hop(
            kind=_kind(entry),
            name=name,
            best=self._best(passage) if is_whole else 0,
            worst=(value.value or 0) + wait,
            source=f"{value.method} ({value.source})",
            parts=parts,
        )

    def _bounds(self, events: Sequence[Event], entry: Entry) -> tuple[Value, Time] | None:
        """The tightest bound of a latency, and how long a message waits until then; None if it has no maximum."""
        quantity = Quantity.MAX_REACTION_TIME if entry is Entry.DATA else Quantity.MAX_REDUCED_REACTION_TIME
        found, reason = [], ""
        for route in routes(events, self.evaluator.context.dataflow):
            for link, first, then in zip(route.links, route.events, route.events[1:], strict=False):
                if link.kind in UNTIMED:
                    raise UnboundedStageError(f"nothing of known time connects {first!r} to {then!r}")
            latencies = self.evaluator.latencies(route)
            reason = latencies.why_unbounded
            best = _tightest(latencies, quantity)
            if best is None:
                raise UnboundedStageError(reason or "no method bounds it")
            found.append(best)
        value = max(found, key=lambda each: each.value or 0)
        if entry is not Entry.POLLING:
            return value, 0
        process = getattr(events[0], "process", "")
        activations = self.evaluator.solution.event_models.get(process)
        wait = activations.max_interarrival if activations is not None else None
        return None if wait is None else (value, wait)

    def _best(self, passage: Passage) -> Time:
        """A lower bound of the time from the first to the last event."""
        times = []
        for route in routes(passage.events, self.evaluator.context.dataflow):
            found = [
                each.value for each in self.evaluator.latencies(route).values() if each.quantity is Quantity.MIN_FIRST_TO_FIRST
            ]
            times.append(max((time for time in found if time is not None), default=0))
        return min(times, default=0)


def _events(passage: Passage, entry: Entry, is_last: bool) -> list[Event]:
    """The events of a passage, from where a message or data enter it to where they leave it."""
    first, last = passage.processes[0], passage.processes[-1]
    found = list(passage.events)
    if entry is not Entry.FIRST:
        change = ProcessChange.START if entry is Entry.DATA else ProcessChange.ACTIVATE
        found.insert(0, ProcessEvent(name=f"{first}_entered", process=first, change=change))
    if not is_last:
        found.append(ProcessEvent(name=f"{last}_left", process=last, change=ProcessChange.TERMINATE))
    return found


def _tightest(latencies: RouteLatencies, quantity: Quantity) -> Value | None:
    found = [each for each in latencies.values() if each.quantity is quantity and each.value is not None]
    return min(found, key=lambda each: each.value or 0, default=None)


def _kind(entry: Entry) -> HopKind:
    return {Entry.POLLING: HopKind.POLLING, Entry.DATA: HopKind.SAMPLING}.get(entry, HopKind.TASKS)


def _unknown(entry: Entry, name: str, reason: str, remedy: str) -> Hop:
    return Hop(kind=_kind(entry), name=name, best=0, worst=None, source="", reason=reason, remedy=remedy)
