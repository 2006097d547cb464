"""From the stations of a chain to the hops of its way.

Each hop is bounded from the instant at which the one before has ended, whatever happened before; so the sum of the worst cases is a
safe bound of the latency, and the sum of the best cases a lower one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from amalthea_uros.analyze.ways.callbacks import CallbackHops
from amalthea_uros.analyze.ways.connections import Connections
from amalthea_uros.analyze.ways.passages import Entry, PassageHops
from amalthea_uros.analyze.ways.results import Way
from amalthea_uros.analyze.ways.stations import Callback, Message, Passage, Station, UnknownWayError, name_of, stations_of
from amalthea_uros.executors.bounds.transmissions import agent_hop, process_hop, received, sent
from amalthea_uros.executors.results import Hop, Part
from amalthea_uros.perf.events import EventChain, LabelEvent
from amalthea_uros.perf.executors import Publication
from amalthea_uros.perf.network import Direction, Span, Transmission
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.units import Time

_SUM = "the latency of a way is the sum of the worst cases of its hops, which need not occur together"
_POLLED = "{!r} takes each message in the first job that is activated after the message has arrived"
_THERE_AND_BACK = "a message that comes back takes 'to_host' and 'to_controller' in the agent at most"


@dataclass(slots=True)
class Walk:
    """Makes the ways of a system.

    Attributes
    ----------
    sending : how long a callback is held up by each message that it sends, by the names of transmissions
    """

    passages: PassageHops
    callbacks: CallbackHops
    sending: Mapping[str, Span]
    connections: Connections = field(init=False)

    def __post_init__(self) -> None:
        self.connections = Connections(self.context)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""
        return self.passages.evaluator.context

    def way(self, chain: EventChain) -> Way:
        """The way of a chain."""
        try:
            stations = self._completed(stations_of(chain, self.context))
            hops, assumptions = self._hops(stations)
            written, last = self._written(chain), stations[-1]
            if written and isinstance(last, Callback):
                hops[-1] = self._until_written(last, hops[-1])
        except (UnknownWayError, UnresolvedError) as error:
            return Way(name=chain.name, start=chain.stimulus or "", end=chain.response or "", hops=(), reason=str(error))
        unknown = next((hop for hop in hops if hop.worst is None), None)
        return Way(
            name=chain.name,
            start=name_of(stations[0]),
            end=written or name_of(stations[-1], is_end=True),
            hops=tuple(hops),
            assumptions=(_SUM, *assumptions),
            reason=unknown.reason if unknown is not None else "",
            remedy=unknown.remedy if unknown is not None else "",
            loss="; ".join(dict.fromkeys(self._losses(stations))),
        )

    def _written(self, chain: EventChain) -> str:
        """The label whose write ends a chain; "" if another event does."""
        end = self.context.system.events_by_name.get(chain.response or "")
        return end.label or "" if isinstance(end, LabelEvent) else ""

    def _completed(self, stations: list[Station]) -> list[Station]:
        """The stations with the callbacks that only take messages for others, without what a message passes by itself."""
        found: list[Station] = []
        for station in stations:
            before = found[-1] if found else None
            if isinstance(station, Passage) and isinstance(before, Message):
                rest = _after(station, before.transmission)
                if rest is None:
                    continue
                taken = self._taken(before.transmission)
                found += [rest] if taken is None else [taken, rest]
            else:
                found.append(station)
        return found

    def _taken(self, transmission: Transmission) -> Callback | None:
        """The callback of an executor that a message makes ready."""
        executors = self.context.system.executors
        ready = [
            Callback(each, handle) for each in executors for handle in each.handles if handle.transmission == transmission.name
        ]
        return ready[0] if ready else None

    def _hops(self, stations: list[Station]) -> tuple[list[Hop], list[str]]:
        hops: list[Hop] = []
        assumptions: list[str] = []
        for index, station in enumerate(stations):
            before, is_last = (stations[index - 1] if index else None), index == len(stations) - 1
            if isinstance(before, Callback) and not isinstance(station, Message):
                hops[-1] = self._until_written(before, hops[-1])
            match station:
                case Message(transmission):
                    if isinstance(before, Message):
                        assumptions.append(_THERE_AND_BACK)
                    hops += self._message(before, transmission, hops)
                case Callback():
                    hops += self._callback(before, station)
                case Passage():
                    entry = self._entry(before, station)
                    if entry is Entry.POLLING:
                        assumptions.append(_POLLED.format(station.processes[0]))
                    hops.append(self.passages.hop(station, entry, is_last))
        return hops, assumptions

    def _message(self, before: Station | None, transmission: Transmission, hops: list[Hop]) -> Iterator[Hop]:
        solution, agent = self.passages.evaluator.solution, agent_hop(transmission, self.passages.evaluator.solution)
        if transmission.direction is Direction.TO_CONTROLLER:
            if before is not None and not (isinstance(before, Message) and before.transmission.direction is Direction.TO_AGENT):
                raise UnknownWayError(f"{name_of(before)!r} sends nothing that the agent forwards to {transmission.topic!r}")
            yield agent
            yield from received(transmission, solution)
            return
        if isinstance(before, Callback):
            publication = _publication(before, transmission)
            if publication is None:
                raise UnknownWayError(f"{before.handle.name!r} does not publish {transmission.topic!r}")
            hops[-1] = _until_sent(hops[-1], self.sending[transmission.name], self._least_sending(before))
        elif isinstance(before, Message):
            raise UnknownWayError(f"{name_of(before)!r} sends nothing")
        elif isinstance(before, Passage) and not self.connections.activates(before, transmission.name):
            raise UnknownWayError(f"{name_of(before, is_end=True)!r} does not publish {transmission.topic!r}")
        yield from sent(transmission, solution)
        yield agent

    def _callback(self, before: Station | None, station: Callback) -> Iterator[Hop]:
        solution = self.passages.evaluator.solution
        transmission = self.context.system.transmissions.get(station.handle.transmission or "")
        passed = transmission.processes if transmission is not None else ()
        if isinstance(before, Message) and before.transmission != transmission:
            raise UnknownWayError(f"{name_of(before)!r} does not make {station.handle.name!r} ready")
        if isinstance(before, Passage) and before.processes[-1] in passed:
            for name in passed[passed.index(before.processes[-1]) + 1 :]:
                yield process_hop(name, solution)
        elif isinstance(before, Callback | Passage):
            self.connections.entry(before, station)
            yield self.callbacks.sampling(station)
            return
        yield self.callbacks.response(station)

    def _until_written(self, station: Callback, hop: Hop) -> Hop:
        """A hop of a callback up to where it has written data: before it sends messages at the earliest."""
        return replace(hop, best=max(0, hop.best - self._least_sending(station)))

    def _least_sending(self, station: Callback) -> Time:
        """How long all messages of a callback hold it up at least."""
        sent = (each.transmission for each in station.handle.publications if each.transmission is not None)
        return sum(self.sending[name].least for name in sent)

    def _entry(self, before: Station | None, station: Passage) -> Entry:
        if before is None:
            return Entry.FIRST
        if isinstance(before, Message):
            is_activated = self.connections.is_activated_after(before.transmission, station.processes[0])
            return Entry.TRIGGER if is_activated else Entry.POLLING
        return self.connections.entry(before, station)

    def _losses(self, stations: list[Station]) -> Iterator[str]:
        """How messages can be lost on a way."""
        lossy = {wire.name for wire in self.context.system.network.wires if wire.loses_messages}
        before: Station | None = None
        for station in stations:
            if isinstance(station, Message) and station.transmission.wire in lossy:
                yield f"messages can be lost on {station.transmission.wire!r}"
            if isinstance(station, Message) and station.transmission.is_dropped_when_busy:
                yield f"a message of {station.transmission.topic!r} is dropped if another thread of the middleware is sending"
            if (
                isinstance(station, Callback)
                and isinstance(before, Message | Passage)
                and station.handle.transmission is not None
            ):
                yield from filter(None, [self.callbacks.loss(station)])
            before = station


def _after(passage: Passage, transmission: Transmission) -> Passage | None:
    """A passage without the processes that a message passes anyway; None if nothing remains."""
    kept = [
        (event, process)
        for event, process in zip(passage.events, passage.processes, strict=True)
        if process not in transmission.processes
    ]
    return Passage(tuple(event for event, _ in kept), tuple(process for _, process in kept)) if kept else None


def _publication(station: Callback, transmission: Transmission) -> Publication | None:
    return next((each for each in station.handle.publications if each.transmission == transmission.name), None)


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
    held_up = Part(name="until it goes on after sending the message", least=-sending.least, most=-sending.most)
    return replace(
        hop,
        worst=hop.worst - sending.most,
        parts=(*hop.parts, held_up) if hop.parts and sending.most else hop.parts,
    )
