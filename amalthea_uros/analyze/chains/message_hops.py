"""The hops at callbacks of executors in loops, and at other tasks and interrupt service routines.

A message waits for the rest of the running iteration, a sleep, messages before it and callbacks before its own; the analysis of
executors bounds this as the response time of the callback. What reads data instead waits for its next run: a timer is due within its
period at the latest, so that the data wait at most that long before the timer becomes due. If it was due already, its call comes even
earlier: either before the data, then the next grid point counts, or after them, with the data.

Other processes are bounded by the analysis of chains. A chain over several controllers without a common clock is bounded by the sum of
its parts (M. Günzel and others, RTAS 2021, theorem 5.8): the reduced reaction time of a part that is activated by the one before or
starts the chain, and the full reaction time of one that reads at its own times, as data can come just after a read. Executors and
wires separate parts in the same way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.segments import CallbackSegment, EntryKind, TaskSegment
from amalthea_uros.analyze.results.chains import LatencyQuantity, LatencyValue
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.results import ExecutorResult, HandleResult, Hop, HopKind, TimePart
from amalthea_uros.executors.semantics.loops import longest_until_due
from amalthea_uros.perf.events import Event, ProcessChange, ProcessEvent
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.relays import arrives_regularly
from amalthea_uros.timing.activation.releases import latest_first_release
from amalthea_uros.timing.dataflow.links import UNTIMED
from amalthea_uros.timing.dataflow.routes import routes
from amalthea_uros.timing.touching import awaited
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class CallbackHops:
    """The hops at the callbacks of executors.

    Attributes
    ----------
    executors : the results of all executors in loops
    jitter : of the arrivals at handles, by name, besides what is stated; None if it is unknown
    """

    executors: Results[ExecutorResult]
    jitter: Mapping[str, Time | None]
    system: System

    def response(self, segment: CallbackSegment) -> Hop:
        """From the arrival of a message, or from when a timer is due, to the end of the callback."""
        name, executor = segment.handle.name, segment.executor.name
        result = self._result(segment)
        bounds = result.response
        if bounds.worst is None:
            return Hop(
                kind=HopKind.EXECUTOR,
                name=executor,
                best=bounds.best,
                worst=None,
                reason=f"the response time of {name!r} in {executor!r} has no bound: {bounds.reason or 'it was not analysed'}",
                remedy=f"See the results of the executor {executor!r}.",
            )
        return Hop(
            kind=HopKind.EXECUTOR,
            name=executor,
            best=bounds.best,
            worst=bounds.worst,
            source=f"response time of {name}: {bounds.method} ({bounds.source})",
            parts=result.terms,
        )

    def loss(self, segment: CallbackSegment) -> str:
        """How messages of a callback can be lost; "" if none can."""
        lost, name = self._result(segment).lost, segment.handle.name
        return "" if lost is None else f"{lost.what} of {name!r} can be lost: {lost.sequence}"

    def sampling(self, segment: CallbackSegment) -> Hop:
        """From a write of data that a callback reads to the end of the callback that reads them, or newer ones."""
        response, handle = self.response(segment), segment.handle
        if response.worst is None:
            return replace(response, kind=HopKind.SAMPLING, best=0)
        # Timers keep their grid when periods are missed; the next message can come at any time if one is lost.
        is_timer = handle.kind is HandleKind.TIMER
        interval, reason = self._longest_interval(segment), "" if is_timer else self.loss(segment)
        if interval is None or reason:
            return Hop(
                kind=HopKind.SAMPLING,
                name=segment.executor.name,
                best=0,
                worst=None,
                reason=reason or f"the time between two messages of {handle.name!r} has no maximum",
                remedy=f"Read the data in a timer callback, or let the path begin with the topic of {handle.name!r}.",
            )
        wait = TimePart(
            name=f"until {handle.name} is due next", least=0, most=interval, why="the data came just after it was due"
        )
        return replace(
            response,
            kind=HopKind.SAMPLING,
            # It can have been called already, and read the data at its very end.
            best=0,
            worst=interval + response.worst,
            source=f"period and response time of {handle.name}",
            parts=(
                wait,
                *(response.parts or (TimePart(name=f"response time of {handle.name}", least=0, most=response.worst),)),
            ),
        )

    def _result(self, segment: CallbackSegment) -> HandleResult:
        return self.executors[segment.executor.name].handles[segment.handle.name]

    def _longest_interval(self, segment: CallbackSegment) -> Time | None:
        """The maximum time between two nominal arrivals, or expirations, or until the first one; None if there is none."""
        handle = segment.handle
        interval, jitter = longest_until_due(handle), self.jitter.get(handle.name, 0)
        if handle.kind is HandleKind.TIMER or interval is None:
            return interval
        return None if jitter is None or not arrives_regularly(handle, self.system) else interval + handle.jitter + jitter


def task_hop(segment: TaskSegment, entry: EntryKind, is_last: bool, evaluator: ChainEvaluator) -> Hop:
    """From the entry of processes outside executors to their last event; if another hop follows, to the end of the job."""
    name, context = " -> ".join(dict.fromkeys(segment.processes)), evaluator.context
    awaiting = (each for process in segment.processes for each in awaited(process, context.system, context.dataflow))
    if (message := next(awaiting, None)) is not None:
        return _unknown(
            entry,
            name,
            f"the response time of {name!r} does not include that it waits for the acknowledgement of {message.topic!r}",
            "Let an executor with a 'loop' run the callback, send with best effort, or set 'reliable: {waits: false}' if the port "
            "does not wait.",
        )
    try:
        bound = _bound(_events(segment, entry, is_last), entry, evaluator)
    except UnknownError as error:
        return _unknown(entry, name, str(error), f"See the results of {name!r}.")
    wait: Time | None = 0
    if entry is EntryKind.POLLING:
        activations = evaluator.solution.event_models.get(segment.processes[0])
        wait = None if activations is None else activations.max_interarrival
    if wait is None:
        reason = f"the maximum time between two activations of {segment.processes[0]!r} is unknown"
        return _unknown(entry, name, reason, f"See the results of {segment.processes[0]!r}.")
    if entry in (EntryKind.DATA, EntryKind.POLLING):
        # Data can also come before its first activation.
        wait += _until_first_activation(segment.processes[0], evaluator)
    parts = (
        TimePart(name=f"until {segment.processes[0]} is activated", least=0, most=wait),
        TimePart(name=f"from its activation through {name}", least=0, most=bound.value),
    )
    return Hop(
        kind=entry.hop,
        name=name,
        best=_best(segment, evaluator) if is_last and entry is EntryKind.FIRST else 0,
        worst=(bound.value or 0) + wait,
        source=f"{bound.method} ({bound.source})",
        parts=parts if wait else (),
    )


def _until_first_activation(process: str, evaluator: ChainEvaluator) -> Time:
    """How much longer the time to the first activation of a process can be than that between two of them."""
    activations, system = evaluator.solution.event_models.get(process), evaluator.context.system
    between = 0 if activations is None else activations.max_interarrival or 0
    return max(0, latest_first_release(system.processes[process], system) - between)


def _bound(events: Sequence[Event], entry: EntryKind, evaluator: ChainEvaluator) -> LatencyValue:
    """The tightest bound of the latency from the first event to the last one.

    Raises
    ------
    UnknownError : there is none.
    """
    quantity = LatencyQuantity.MAX_REACTION_TIME if entry is EntryKind.DATA else LatencyQuantity.MAX_REDUCED_REACTION_TIME
    found = routes(events, evaluator.context.dataflow)
    for route in found:
        for link, (first, then) in zip(route.links, pairwise(route.events), strict=True):
            if link.kind in UNTIMED:
                raise UnknownError(f"nothing of known time connects {first!r} to {then!r}")
    bound = next((value for value in evaluator.worst(found) if value.quantity is quantity), None)
    if bound is None:
        whys = (evaluator.latencies(route).why_unbounded for route in found)
        raise UnknownError(next(filter(None, whys), "no method bounds it"))
    return bound


def _best(segment: TaskSegment, evaluator: ChainEvaluator) -> Time:
    """A lower bound of the time from the first to the last event."""
    values = evaluator.worst(routes(segment.events, evaluator.context.dataflow))
    return next((value.value or 0 for value in values if value.quantity is LatencyQuantity.MIN_FIRST_TO_FIRST), 0)


def _events(segment: TaskSegment, entry: EntryKind, is_last: bool) -> list[Event]:
    """The events of a segment, from where a message or data enter it to where they leave it."""
    first, last = segment.processes[0], segment.processes[-1]
    events = list(segment.events)
    if entry is not EntryKind.FIRST:
        change = ProcessChange.START if entry is EntryKind.DATA else ProcessChange.ACTIVATE
        events.insert(0, ProcessEvent(name=f"{first}_entered", process=first, change=change))
    if not is_last:
        events.append(ProcessEvent(name=f"{last}_left", process=last, change=ProcessChange.TERMINATE))
    return events


def _unknown(entry: EntryKind, name: str, reason: str, remedy: str) -> Hop:
    return Hop(kind=entry.hop, name=name, best=0, worst=None, reason=reason, remedy=remedy)
