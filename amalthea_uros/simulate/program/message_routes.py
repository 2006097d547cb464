"""The routes of chains that pass wires and executors that loop."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise, product

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.callbacks import handle_around, taker
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.events import CustomEvent, Event, EventChain, RunnableChange, RunnableEvent
from amalthea_uros.perf.executors import Handle
from amalthea_uros.perf.network import Direction, Transmission, plain_topic
from amalthea_uros.simulate.program.host_system import why_not_simulated
from amalthea_uros.simulate.program.messages import MessageRecords
from amalthea_uros.timing.activation.relays import relayed
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import sequences, unfold
from amalthea_uros.timing.dataflow.events import EventOccurrence
from amalthea_uros.timing.dataflow.links import Link, LinkKind
from amalthea_uros.timing.dataflow.routes import Route
from amalthea_uros.timing.jobs.positions import ActivityPosition


@dataclass(frozen=True, slots=True)
class MessageRoutes:
    """Finds the routes of chains over messages."""

    messages: MessageRecords

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""
        return self.messages.resources.context

    def of(self, chain: EventChain) -> dict[tuple[str, ...], list[Route]]:
        """The routes of a chain, by the events of its paths.

        Raises
        ------
        UnknownError : nothing takes the effect from an event to the next, or an event has no place of its own.
        """
        events = self.context.system.events_by_name
        self._check_host(events[name] for path in sequences(unfold(chain, self.context.system)[0]) for name in path)
        paths = sequences(unfold(chain, self.context.system)[0])
        return {tuple(path): [self._route(self._with_takers([events[name] for name in path]))] for path in paths}

    def _check_host(self, events: Iterable[Event]) -> None:
        """Refuse callbacks of the host that are not simulated."""
        system = self.context.system
        for event in events:
            callback = system.callback_of_host_event.get(event.name)
            if isinstance(event, CustomEvent) and callback is not None:
                raise UnknownError(f"it passes callbacks of the host: {why_not_simulated(system)}")

    def _with_takers(self, events: Sequence[Event]) -> list[Event]:
        """The events, and those of callbacks that only take a message for a task of its own."""
        completed: list[Event] = []
        for event in events:
            before = self._transmission(completed[-1]) if completed else None
            ready = None if before is None else taker(before, self.context.system)
            if ready is not None and all(each.process.name != ready[0].task for each in self._occurrences(event)):
                runnable = ready[1].runnable
                change, task = RunnableChange.TERMINATE, ready[0].task
                if self._transmission(event) is None:
                    completed.append(RunnableEvent(name=runnable, runnable=runnable, change=change, process=task))
            completed.append(event)
        return completed

    def _occurrences(self, event: Event) -> list[EventOccurrence]:
        """Where an event can occur; the first thread of an executor of the host stands for all of them."""
        host = self.messages.host
        return [
            each
            for each in self.context.dataflow.events.of(event)
            if each.process.name == next(iter(host.threads_beside(each.process.name)))
        ]

    def _transmission(self, event: Event) -> Transmission | None:
        """The message of which an event is, if it is one."""
        names = {each.process.name for each in self._occurrences(event)}
        return self.context.system.transmissions.get(names.pop()) if len(names) == 1 else None

    def _route(self, events: Sequence[Event]) -> Route:
        choices = [self._occurrences(event) for event in events]
        candidates = [
            (occurrences, [self._link(first, then) for first, then in pairwise(occurrences)])
            for occurrences in product(*choices)
        ]
        whole = [(occurrences, links) for occurrences, links in candidates if None not in links]
        if len(whole) > 1:
            raise UnknownError("its events can occur in several places; set the process of each event")
        if not whole:
            gap = candidates[0][1].index(None)
            message = self._transmission(events[gap])
            is_received = message is not None and message.direction is Direction.TO_CONTROLLER
            if message is not None and is_received and taker(message, self.context.system) is None:
                raise UnknownError(f"{message.callback!r} takes {message.topic!r} outside of an executor with a loop")
            raise UnknownError(f"nothing takes the effect from {events[gap].name!r} to {events[gap + 1].name!r}")
        occurrences, links = whole[0]
        return Route(tuple(event.name for event in events), occurrences, tuple(link for link in links if link is not None))

    def _link(self, first: EventOccurrence, then: EventOccurrence) -> Link | None:
        """The link from one event to the next; None if nothing takes the effect on."""
        system = self.context.system
        before, after = (system.transmissions.get(each.process.name) for each in (first, then))
        if any(self.messages.host.callback_at(each.position) for each in (first, then)):
            return self._on_host(first, then)
        if before is not None and first.process is not then.process:
            if after is not None:
                return Link(LinkKind.RELAY, (before.topic or "",)) if before in relayed(after, system) else None
            return self._taken(before, then) if before.direction is Direction.TO_CONTROLLER else None
        return next((link for link in self._links(first, then) if link.kind is not LinkKind.MESSAGE), None)

    def _on_host(self, first: EventOccurrence, then: EventOccurrence) -> Link | None:
        """How messages take the effect to a callback of the host, or from there."""
        host, transmissions = self.messages.host, self.context.system.transmissions
        one, other = host.callback_at(first.position), host.callback_at(then.position)
        if one is not None and one == other:
            return Link(LinkKind.JOB)
        if one is None and other is not None:
            sent = transmissions.get(first.process.name)
            is_received = sent is not None and sent.direction is Direction.TO_AGENT and plain_topic(sent.topic) == other.topic
            return Link(LinkKind.QUEUE, (other.topic or "",), read=then.position) if is_received else None
        if one is None:
            return None
        if other is not None:
            is_sent = other.topic in one.publishes
            return Link(LinkKind.QUEUE, (other.topic or "",), write=first.position, read=then.position) if is_sent else None
        received = transmissions.get(then.process.name)
        topic = "" if received is None else plain_topic(received.topic)
        return Link(LinkKind.RELAY, (topic,), write=first.position) if topic in one.publishes else None

    def _links(self, first: EventOccurrence, then: EventOccurrence) -> Iterator[Link]:
        """The links of the data flow of processes, without those of calls of other handles."""
        one, other = self._handle_around(first), self._handle_around(then)
        if first.process.name == then.process.name and one is not None and one == other:
            # A callback is called once in an iteration.
            yield Link(LinkKind.JOB)
            return
        # Data that a callback leaves for another one can be read in the same iteration, or in a later one.
        is_same = one is not None and first.process.name == then.process.name
        flow = self.context.dataflow
        for link in flow.data(first, then) if is_same else flow.links(first, then):
            if self._is_within(link.write, first) and self._is_within(link.read, then):
                yield link

    def _is_within(self, position: ActivityPosition | None, occurrence: EventOccurrence) -> bool:
        handle = self._handle_around(occurrence)
        return handle is None or position is None or self._around(position) == handle

    def _taken(self, transmission: Transmission, then: EventOccurrence) -> Link | None:
        """How an executor takes a message."""
        ready = taker(transmission, self.context.system)
        if ready is None or ready[0].task != then.process.name or self._handle_around(then) != ready[1]:
            return None
        positions = self.context.dataflow.events.positions(then.process.name)
        first = next(each for each in positions if isinstance(each.activity, Call) and self._around(each) == ready[1])
        return Link(LinkKind.QUEUE, (transmission.topic or "",), read=first)

    def _handle_around(self, occurrence: EventOccurrence) -> Handle | None:
        """The handle of the callback in which an event occurs; None outside executors.

        Raises
        ------
        UnknownError : it is an event of a whole iteration.
        """
        executor = self.context.system.executor_of_task.get(occurrence.process.name)
        if executor is None:
            return None
        handle = None if occurrence.position is None else self._around(occurrence.position)
        if handle is None:
            raise UnknownError(f"an event is one of a whole iteration of {executor.name!r}; name a callback or a topic")
        return handle

    def _around(self, position: ActivityPosition) -> Handle | None:
        executor = self.context.system.executor_of_task.get(position.process.name)
        return None if executor is None else handle_around(position, executor, self.context.dataflow.events)
