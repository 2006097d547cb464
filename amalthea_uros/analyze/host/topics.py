"""Who publishes what the callbacks of a host receive: other callbacks, the agent, or something that is not described."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

from amalthea_uros._internal.graphs import circles
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.bounds.transmissions import agent_hop, sent, variation
from amalthea_uros.perf.host import Host, HostCallback, HostExecutor, HostTopic
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission, plain_topic
from amalthea_uros.timing.event_models.derived import Delayed
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents
from amalthea_uros.units import Time


def delayed(events: EventModel, late: Time) -> EventModel:
    """Events that are delayed by a time that varies by so much."""
    if isinstance(events, PeriodicEvents) and (late or not events.min_interarrival):
        return PeriodicEvents(events.period, events.jitter + late)
    return Delayed(events, late) if late else events


@dataclass(frozen=True)
class HostTopics:
    """The topics of a host.

    Attributes
    ----------
    solved : the controller
    by_group : multi-threaded executors of which each callback group is analysed like an executor
    """

    host: Host
    solved: SolvedSystem
    by_group: frozenset[str] = frozenset()

    @cached_property
    def executor_of(self) -> Mapping[str, HostExecutor]:
        """The executors, by callback."""
        return {callback.name: executor for executor in self.host.executors for callback in executor.callbacks}

    @cached_property
    def callbacks(self) -> Mapping[str, HostCallback]:
        """The callbacks by name."""
        return {callback.name: callback for callback in self.host.callbacks}

    @cached_property
    def described(self) -> Mapping[str, HostTopic]:
        """The topics by name."""
        return {topic.name: topic for topic in self.host.topics}

    @cached_property
    def _publishers(self) -> Mapping[str, list[HostCallback]]:
        """The callbacks of the host that publish a topic, by its name, each as often as a call of it does."""
        publishers: dict[str, list[HostCallback]] = {}
        for callback in self.host.callbacks:
            for topic in callback.publishes:
                publishers.setdefault(topic, []).append(callback)
        return publishers

    def publishers(self, topic: str) -> Sequence[HostCallback]:
        """The callbacks of the host that publish a topic, each as often as a call of it does."""
        return self._publishers.get(topic, ())

    def circles(self) -> list[set[str]]:
        """The callbacks that publish to each other in a circle, by name."""

        def before(name: str) -> list[str]:
            topic = self.callbacks[name].topic
            return [] if topic is None else [each.name for each in self.publishers(topic)]

        return circles(self.callbacks, before)

    def transmissions(self, topic: str, direction: Direction) -> list[Transmission]:
        """The messages of a topic on the wires of the controller."""
        return [
            each
            for each in self.solved.context.system.network.transmissions
            if each.purpose is Purpose.DATA and each.direction is direction and plain_topic(each.topic) == topic
        ]

    def latency(self, topic: str) -> Span:
        """From a publication of a topic to the queue of a subscription."""
        described = self.described.get(topic)
        return Span() if described is None else described.latency

    def source(self, callback: HostCallback) -> HostCallback | None:
        """The callback whose messages reach another one of its executor at its end, and nothing else does; None if there is none."""
        topic = callback.topic
        if topic is None or self.latency(topic).most != 0 or self.transmissions(topic, Direction.TO_AGENT):
            return None
        publishers = self.publishers(topic)
        is_alone = len(publishers) == 1 and self._is_served_with(publishers[0], callback)
        return publishers[0] if is_alone else None

    def _is_served_with(self, one: HostCallback, other: HostCallback) -> bool:
        executor = self.executor_of[one.name]
        is_in_executor = executor.name == self.executor_of[other.name].name
        return is_in_executor and (executor.name not in self.by_group or one.group == other.group)

    def route(self, callback: HostCallback) -> tuple[HostCallback, ...]:
        """The callbacks of its executor through which a release reaches a callback, itself included.

        Raises
        ------
        UnknownError : they publish in a circle.
        """
        if callback.name not in self._routes:
            route = [callback]
            while (before := self.source(route[0])) is not None:
                if before in route:
                    raise UnknownError(f"the messages of {callback.name!r} are published in a circle")
                route.insert(0, before)
            self._routes[callback.name] = tuple(route)
        return self._routes[callback.name]

    @cached_property
    def _routes(self) -> dict[str, tuple[HostCallback, ...]]:
        """The routes that were asked for, by their last callbacks."""
        return {}

    def from_controller(self, transmission: Transmission) -> EventModel:
        """The messages of a controller when the agent publishes them.

        Raises
        ------
        UnknownError : their number or a hop before has no bound.
        """
        events, hops = self.solved.event_models.get(transmission.name), [*sent(transmission, self.solved)]
        hops.append(agent_hop(transmission, self.solved))
        late = variation(hops)
        if late is None:
            raise UnknownError(next(hop.reason for hop in hops if hop.worst is None))
        if events is None:
            raise UnknownError(f"it is not known how often {transmission.callback!r} sends")
        return delayed(events, late)
