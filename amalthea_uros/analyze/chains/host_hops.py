"""The hops of a chain on the host: callbacks that wake each other within an executor, topics, and variables that a callback reads.

Within an executor, one bound holds for the whole route (D. Casini et al., ECRTS 2019, section 5); that of each callback can be less in
sum, so that the smaller one counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.chains.segments import ChainSegment, HostSegment, name_of
from amalthea_uros.analyze.host.handover import violated
from amalthea_uros.analyze.host.results import HostResults
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.results import HandleResult, Hop, HopKind
from amalthea_uros.perf.host import HostCallback
from amalthea_uros.perf.network import Direction, Transmission, plain_topic
from amalthea_uros.timing.activation.relays import relayed
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class HostHops:
    """The hops on the host.

    Attributes
    ----------
    solved : the controller
    """

    host: HostResults
    solved: SolvedSystem

    def of(self, before: ChainSegment | None, segment: HostSegment) -> Iterator[Hop]:
        """From the end of the segment before to the end of the last callback.

        Raises
        ------
        UnknownError : no data flow or trigger connects them.
        """
        first = segment.callbacks[0]
        if isinstance(before, Transmission):
            if before.direction is not Direction.TO_AGENT or plain_topic(before.topic) != first.topic:
                raise UnknownError(f"{first.name!r} does not subscribe to {name_of(before)!r}")
            yield self._topic(first.topic or "")
        elif before is not None:
            raise UnknownError(
                f"a message takes the effect from {name_of(before)!r} to {first.name!r}; add its topic to the path"
            )
        route, is_sampled = [first], False
        for one, other in pairwise(segment.callbacks):
            if self.host.releases.topics.source(other) == one:
                route.append(other)
                continue
            yield self._entered(route, is_sampled)
            is_sampled = other.topic is None or other.topic not in one.publishes
            if not is_sampled:
                yield self._topic(other.topic or "")
            elif not set(one.writes) & set(other.reads):
                raise UnknownError(f"no topic or variable connects {one.name!r} to {other.name!r}")
            route = [other]
        yield self._entered(route, is_sampled)

    def leaving(self, segment: HostSegment, transmission: Transmission) -> Hop:
        """From the last callback to the agent.

        Raises
        ------
        UnknownError : it does not publish the topic, or its messages are not as stated.
        """
        topic, last = plain_topic(transmission.topic), segment.callbacks[-1]
        if topic not in last.publishes:
            raise UnknownError(f"{last.name!r} does not publish {topic!r}")
        if difference := violated(transmission, self.host.releases):
            raise UnknownError(difference)
        return self._topic(topic)

    def between(self, sent: Transmission, received: Transmission) -> Iterator[Hop]:
        """From the agent of one controller to that of another one; nothing within one agent.

        Raises
        ------
        UnknownError : the agents do not send one as the other, or the messages are not as stated.
        """
        if sent not in relayed(received, self.solved.context.system):
            raise UnknownError(
                f"{name_of(sent)!r} is not sent on as {name_of(received)!r}: the chain leaves out what receives one and sends the other"
            )
        if difference := violated(received, self.host.releases):
            raise UnknownError(difference)
        if sent.wire != received.wire:
            yield self._topic(plain_topic(received.topic))

    def losses(self, segment: HostSegment) -> Iterator[str]:
        """How messages can be lost on the path of a chain."""
        yield from self._losses(segment.callbacks)

    def _losses(self, callbacks: Iterable[HostCallback]) -> Iterator[str]:
        for callback in callbacks:
            lost = self._result(callback).lost
            if lost is not None and callback.topic is not None:
                yield f"{lost.what} of {callback.name!r} can be lost: {lost.sequence}"

    def _result(self, callback: HostCallback) -> HandleResult:
        executor = self.host.releases.topics.executor_of[callback.name]
        return self.host.executors[executor.name].handles[callback.name]

    def _topic(self, topic: str) -> Hop:
        latency = self.host.releases.topics.latency(topic)
        if latency.most is None:
            reason = f"the latency of the topic {topic!r} is not specified"
            remedy = f"Measure it, and set 'latency' of {topic!r} under 'topics' of the host."
            return Hop(kind=HopKind.TOPIC, name=f"/{topic}", best=latency.least, reason=reason, remedy=remedy)
        return Hop(kind=HopKind.TOPIC, name=f"/{topic}", best=latency.least, worst=latency.most, source="stated")

    def _route(self, route: Sequence[HostCallback]) -> Hop:
        """From the release of the first callback to the end of the last one, in one executor."""
        releases = self.host.releases
        executor, best = releases.topics.executor_of[route[0].name].name, sum(each.execution.least for each in route)
        responses = [self._result(each).response for each in route]
        unknown = next((each for each in responses if each.worst is None), None)
        name = f"{executor}: {', '.join(each.name for each in route)}"
        if unknown is not None:
            reason = (
                f"the response time of {route[responses.index(unknown)].name!r} in {executor!r} has no bound: {unknown.reason}"
            )
            remedy = f"See the results of the executor {executor!r}."
            return Hop(kind=HopKind.HOST, name=name, best=best, reason=reason, remedy=remedy)
        hop_by_hop, latency = sum(each.worst or 0 for each in responses), releases.latencies[route[-1].name]
        whole = (latency.worst or 0) - releases.best(route[0]) + route[0].execution.least
        method = f"response time: {responses[0].method} ({responses[0].source})"
        by_hop = method if len(route) == 1 else "sum of response times"
        source = by_hop if hop_by_hop <= whole else f"latency of the route: {latency.method} ({latency.source})"
        parts = self._result(route[0]).terms if len(route) == 1 and hop_by_hop <= whole else ()
        return Hop(kind=HopKind.HOST, name=name, best=best, worst=min(hop_by_hop, whole), source=source, parts=parts)

    def _entered(self, route: Sequence[HostCallback], is_sampled: bool) -> Hop:
        """The hop of callbacks that wake each other, from a message for the first one, or from a write of a variable that it reads."""
        hop, last = self._route(route), route[-1]
        if not is_sampled or hop.worst is None:
            return replace(hop, kind=HopKind.SAMPLING, best=0) if is_sampled else hop
        hop = replace(hop, kind=HopKind.SAMPLING, best=hop.best - route[0].execution.least, parts=())
        try:
            worst = self._from_any_time(last, route)
        except UnknownError as error:
            remedy = "Read the variable in a timer, or let the path begin with the topic of the callback."
            return replace(hop, worst=None, source="", reason=str(error), remedy=remedy)
        return replace(hop, worst=worst, source=f"time between two calls of {route[0].name} and until the end of {last.name}")

    def _from_any_time(self, callback: HostCallback, path: Sequence[HostCallback] = ()) -> Time:
        """From any time to the end of the first call of a callback for a timer that is called at that time or later.

        A timer keeps its grid: the next time at which it is due is at most a period later, also if periods are skipped.

        Parameters
        ----------
        path : callbacks whose losses are those of the chain

        Raises
        ------
        UnknownError : there is no maximum.
        """
        topics = self.host.releases.topics
        route = topics.route(callback)
        hop, head = self._route(route), route[0]
        if hop.worst is None:
            raise UnknownError(hop.reason)
        if lost := next(self._losses(each for each in route if each not in path), None):
            raise UnknownError(lost)
        if head.period is not None:
            longest, windows = head.period + hop.worst, self.host.releases.windows.get(topics.executor_of[head.name].name)
            return longest if windows is None else min(longest, windows.from_any_time(route))
        latency = topics.latency(head.topic or "").most
        publishers = topics.publishers(head.topic or "")
        if latency is None or not publishers:
            raise UnknownError(f"the time between two messages of {head.name!r} has no maximum")
        return min(map(self._from_any_time, publishers)) + latency + hop.worst
