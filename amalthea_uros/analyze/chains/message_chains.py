"""Chains that cross wires, the agent or executors in loops: the sum of their hops.

Each hop is bounded from the instant at which the one before has ended, whatever happened before; so the sum of the worst cases is a
safe bound of the latency, and the sum of the best cases a lower one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.chains.host_hops import HostHops
from amalthea_uros.analyze.chains.message_hops import CallbackHops, task_hop
from amalthea_uros.analyze.chains.segments import (
    CallbackSegment,
    ChainSegment,
    EntryKind,
    HostSegment,
    Segments,
    TaskSegment,
    name_of,
)
from amalthea_uros.analyze.host.evaluate import evaluate_host
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity, LatencyValue
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.evaluate import evaluate_executors
from amalthea_uros.executors.bounds.occurrences import MessageTimes
from amalthea_uros.executors.bounds.transmissions import (
    agent_hop,
    process_hop,
    received,
    sent,
    wait_for_missing,
)
from amalthea_uros.executors.results import ExecutorResult, Hop, TimePart
from amalthea_uros.executors.semantics.demand import IterationDemand
from amalthea_uros.perf.constraints import LatencyConstraint
from amalthea_uros.perf.events import EventChain, LabelEvent
from amalthea_uros.perf.network import Direction, Span, Transmission
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.routes import crosses
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time, up

#: The method of the bound, as tables and JSON call it.
METHOD = "sum of hop bounds"
#: Response times of the parts are added up, which needs no assumption on when their worst cases occur.
SOURCE = "compositional analysis, K. Richter 2005"
_SUM = "the latency of a chain over wires or executors is the sum of the worst cases of its hops, which need not occur together"
_POLLED = "{!r} takes each message in the first job that is activated after the message has arrived"
_THERE_AND_BACK = "a message that comes back takes 'to_host' and 'to_controller' in the agent at most"


def evaluate_executors_and_messages(
    solution: Solution,
) -> tuple[Results[ExecutorResult], Results[ChainResult], Results[ExecutorResult]]:
    """The results of all executors in loops, of all chains that cross them, wires, the agent or the host, and of executors of the host.

    Parameters
    ----------
    solution : for unknown phases, in which any job can take what comes from outside
    """
    times = MessageTimes.merged(map(MessageTimes.of, solution.clients))
    results = (evaluate_executors(each, sending=times.sending, extra_jitter=times.jitter) for each in solution.clients)
    executors = Results(result for each in results for result in each)
    host, system = evaluate_host(solution), solution.context.system
    solution.jobs += host.releases.jobs
    evaluator = MessageChains(
        ChainEvaluator(solution),
        CallbackHops(executors, times.jitter, system),
        times.sending,
        times.waits,
        HostHops(host, solution),
    )
    limited = {each.chain for each in system.constraints.constraints if isinstance(each, LatencyConstraint)}
    crossing = [chain for chain in system.events.chains if crosses(chain, solution.context.dataflow)]
    chains = Results(evaluator.chain(chain) for chain in sorted(crossing, key=lambda chain: chain.name not in limited))
    for result in chains:
        _note(result, solution)
    return executors, chains, host.executors


def _note(result: ChainResult, solution: Solution) -> None:
    """Report a chain without a bound, and its assumptions."""
    notes = solution.context.notes
    for sentence in result.assumptions:
        notes.assume(sentence)
    if result.reason:
        advice = f" {result.remedy}" if result.remedy else ""
        message = f"the latency of {result.name!r} has no bound: {result.reason}.{advice}"
        notes.warning("CHN009", message, solution.context.system.chains[result.name])


@dataclass(slots=True)
class MessageChains:
    """Evaluates chains hop by hop.

    Attributes
    ----------
    sending : how long a callback is held up by each message that it sends, by the names of transmissions
    waits : how long reliable messages can wait for missing ones, by the names of transmissions
    """

    evaluator: ChainEvaluator
    callbacks: CallbackHops
    sending: Mapping[str, Span]
    waits: Mapping[str, Time | None]
    host: HostHops
    segments: Segments = field(init=False)

    def __post_init__(self) -> None:
        self.segments = Segments(self.context)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""
        return self.evaluator.context

    @property
    def solution(self) -> Solution:
        """The response times of the system."""
        return self.evaluator.solution

    def chain(self, chain: EventChain) -> ChainResult:
        """The latency of a chain; its data age is not bounded."""
        try:
            segments = self.segments.of(chain)
            hops, assumptions = self._hops(segments)
            end, last = self.context.system.events_by_name.get(chain.response or ""), segments[-1]
            # A chain that ends with a write does not last until the end of the callback.
            written = end.label or "" if isinstance(end, LabelEvent) else ""
            if written and isinstance(last, CallbackSegment):
                hops[-1] = self._until_written(last, hops[-1])
        except UnknownError as error:
            unknown_hops = ChainResult(name=chain.name, communication="", reason=str(error))
            return _result(replace(unknown_hops, start=chain.stimulus or "", end=chain.response or ""))
        unknown = next((hop for hop in hops if hop.worst is None), None)
        loss = "; ".join(dict.fromkeys(self._losses(segments)))
        return _result(
            ChainResult(
                name=chain.name,
                communication="",
                start=name_of(segments[0]),
                end=written or name_of(segments[-1], is_end=True),
                hops=Results(hops),
                assumptions=(_SUM, *assumptions),
                reason=unknown.reason if unknown is not None else loss,
                remedy=unknown.remedy if unknown is not None else "",
                loss=loss,
            )
        )

    def _hops(self, segments: Sequence[ChainSegment]) -> tuple[list[Hop], list[str]]:
        hops: list[Hop] = []
        assumptions: list[str] = []
        for index, segment in enumerate(segments):
            before, is_last = (segments[index - 1] if index else None), index == len(segments) - 1
            if isinstance(before, CallbackSegment) and not isinstance(segment, Transmission):
                hops[-1] = self._until_written(before, hops[-1])
            match segment:
                case Transmission() as transmission:
                    if isinstance(before, Transmission) and before.wire == transmission.wire:
                        assumptions.append(_THERE_AND_BACK)
                    hops += self._message(before, transmission, hops)
                case CallbackSegment():
                    hops += self._callback(before, segment)
                case HostSegment():
                    hops += self.host.of(before, segment)
                case TaskSegment():
                    entry = self.segments.entry(before, segment)
                    if entry is EntryKind.POLLING:
                        assumptions.append(_POLLED.format(segment.processes[0]))
                    hops.append(task_hop(segment, entry, is_last, self.evaluator))
        return hops, assumptions

    def _message(self, before: ChainSegment | None, transmission: Transmission, hops: list[Hop]) -> Iterator[Hop]:
        yield from self._message_hops(before, transmission, hops)
        if wait := wait_for_missing(transmission, self.context.system, self.waits):
            yield wait

    def _message_hops(self, before: ChainSegment | None, transmission: Transmission, hops: list[Hop]) -> Iterator[Hop]:
        agent, topic = agent_hop(transmission, self.solution), transmission.topic
        if transmission.direction is Direction.TO_CONTROLLER:
            is_from_host = isinstance(before, Transmission) and before.direction is Direction.TO_AGENT
            if isinstance(before, HostSegment):
                yield self.host.leaving(before, transmission)
            elif isinstance(before, Transmission) and is_from_host:
                yield from self.host.between(before, transmission)
            elif before is not None:
                raise UnknownError(f"{name_of(before)!r} sends nothing that the agent forwards to {topic!r}")
            yield agent
            yield from received(transmission, self.solution)
            return
        match before:
            case CallbackSegment(_, handle):
                if all(each.transmission != transmission.name for each in handle.publications):
                    raise UnknownError(f"{handle.name!r} does not publish {topic!r}")
                hops[-1] = _until_sent(hops[-1], self.sending[transmission.name], self._least_sending(before))
            case Transmission():
                raise UnknownError(f"{name_of(before)!r} sends nothing")
            case HostSegment():
                raise UnknownError(f"{name_of(before, is_end=True)!r} of the host does not send {topic!r} on the wire")
            case TaskSegment() if not self.segments.activates(before, transmission.name):
                raise UnknownError(f"{name_of(before, is_end=True)!r} does not publish {topic!r}")
        yield from sent(transmission, self.solution)
        yield agent

    def _callback(self, before: ChainSegment | None, segment: CallbackSegment) -> Iterator[Hop]:
        transmission = self.context.system.transmissions.get(segment.handle.transmission or "")
        passed = transmission.processes if transmission is not None else ()
        if isinstance(before, Transmission) and before != transmission:
            raise UnknownError(f"{name_of(before)!r} does not make {segment.handle.name!r} ready")
        if isinstance(before, TaskSegment) and before.processes[-1] in passed:
            for name in passed[passed.index(before.processes[-1]) + 1 :]:
                yield process_hop(name, self.solution)
        elif isinstance(before, CallbackSegment | TaskSegment | HostSegment):
            self.segments.entry(before, segment)
            yield self.callbacks.sampling(segment)
            return
        response = self.callbacks.response(segment)
        yield self._from_start(segment, response) if before is None else response

    def _from_start(self, segment: CallbackSegment, hop: Hop) -> Hop:
        """A hop of a callback from its start, before which its message has been taken."""
        if not hop.best:
            return hop
        taken = IterationDemand.of(segment.executor, self.context).takes[segment.handle.name]
        return replace(hop, best=max(0, hop.best - up(Fraction(taken.lower, self.context.time_base(segment.executor.task)))))

    def _until_written(self, segment: CallbackSegment, hop: Hop) -> Hop:
        """A hop of a callback up to where it has written data: before it sends messages at the earliest."""
        return replace(hop, best=max(0, hop.best - self._least_sending(segment)))

    def _least_sending(self, segment: CallbackSegment) -> Time:
        """How long all messages of a callback hold it up at least."""
        names = (each.transmission for each in segment.handle.publications if each.transmission is not None)
        return sum(self.sending[name].least for name in names)

    def _losses(self, segments: Sequence[ChainSegment]) -> Iterator[str]:
        """How messages can be lost on the path of a chain."""
        lossy = {wire.name for wire in self.context.system.network.wires if wire.loses_messages}
        before: ChainSegment | None = None
        for segment in segments:
            if isinstance(segment, Transmission):
                if segment.wire in lossy and self.waits.get(segment.name) is None:
                    yield f"messages can be lost on {segment.wire!r}"
                if segment.is_dropped_when_busy:
                    yield f"a message of {segment.topic!r} is dropped if another thread of the middleware is sending"
            elif (
                isinstance(segment, CallbackSegment)
                and segment.handle.transmission is not None
                and isinstance(before, Transmission | TaskSegment)
            ):
                yield from filter(None, [self.callbacks.loss(segment)])
            elif isinstance(segment, HostSegment):
                yield from self.host.losses(segment)
            before = segment


def _until_sent(hop: Hop, sending: Span, least: Time) -> Hop:
    """A hop of a callback up to where it sends a message, instead of its end.

    The bound of its response time has the whole time for which the message holds it up, after everything before it.

    Parameters
    ----------
    least : for which all its messages hold it up at least, as this one can be the first of them
    """
    hop = replace(hop, best=max(0, hop.best - least))
    if hop.worst is None or sending.most is None:
        return hop
    held_up = TimePart(name="until it goes on after sending the message", least=-sending.least, most=-sending.most)
    parts = (*hop.parts, held_up) if hop.parts and sending.most else hop.parts
    return replace(hop, worst=hop.worst - sending.most, parts=parts)


def _result(found: ChainResult) -> ChainResult:
    """The result with what its hops add up to, in the terms of all chains, so that limits are judged by it."""
    hops, worst = found.hops, found.worst_if_not_lost
    values = [_value(LatencyQuantity.MIN_FIRST_TO_FIRST, sum(hop.best for hop in hops))] if hops else []
    if worst:
        hops = Results(replace(hop, share=Fraction(hop.worst or 0, worst)) for hop in hops)
    if worst is not None and not found.loss:
        values.append(_value(LatencyQuantity.MAX_REDUCED_REACTION_TIME, worst))
    return replace(
        found,
        communication="over wires and executors",
        routes=(" -> ".join((found.start, *dict.fromkeys(hop.name for hop in hops), found.end)),),
        values=tuple(values),
        all_values=tuple(values),
        why="bounds: the worst cases of the hops need not occur together",
        crosses_messages=True,
        hops=hops,
    )


def _value(quantity: LatencyQuantity, time: Time) -> LatencyValue:
    return LatencyValue(quantity=quantity, value=time, claim=Claim.BOUND, method=METHOD, source=SOURCE)
