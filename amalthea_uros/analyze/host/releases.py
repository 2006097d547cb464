"""How often the callbacks of a host are released, and how long after their chains have entered the executor they end.

A callback whose message is published within the same executor has the activations of the first callback of that chain: so the bound of
D. Casini et al., ECRTS 2019, section 5, holds for its end, and no jitter adds up from hop to hop. Between executors, and where a topic
takes time, the jitter is what the times before vary (K. Richter 2005). It is found by iteration from none upwards.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.analyze.host import polled
from amalthea_uros.analyze.host.multi_threaded import SharedThreads, has_thread_for_each_group, in_groups
from amalthea_uros.analyze.host.processor import HostProcessor, processor_of
from amalthea_uros.analyze.host.topics import HostTopics, delayed
from amalthea_uros.analyze.host.windows import Windows
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.host import HostCallback, HostExecutor, HostExecutorKind
from amalthea_uros.perf.network import Direction
from amalthea_uros.timing.basics.time_base import Ticks
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.derived import aggregated
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents, SporadicEvents
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Time

#: Jitter that still grows after so many passes is considered unbounded, and so is a latency of so many times that of the first pass.
_MAX_PASSES, _MAX_GROWTH = 200, 50
_GROWS = "the jitter of its messages grows from hop to hop without a bound"


@dataclass
class HostReleases:
    """The releases of all callbacks of a host.

    Attributes
    ----------
    latencies : from the release of the first callback of the route to the end of a callback, by name
    reasons : why nothing is known of an executor
    processors : by the names of executors
    windows : of the executors for which these bound latencies, by name
    jobs : number of jobs that were examined in all passes
    """

    topics: HostTopics
    latencies: dict[str, Response] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    processors: dict[str, HostProcessor] = field(default_factory=dict)
    windows: dict[str, Windows] = field(default_factory=dict)
    jobs: int = 0

    def solve(self) -> HostReleases:
        """Find the least fixed point, executor by executor; what has none is unknown."""
        self._solve_all()
        overloaded = {
            executor.name
            for executor in self.topics.host.executors
            if executor.name in self.reasons and self.has_thread_for_each_group(executor)
        }
        if not overloaded:
            return self
        by_group = HostReleases(replace(self.topics, by_group=frozenset(overloaded)), jobs=self.jobs)
        by_group._solve_all()
        return by_group

    def has_thread_for_each_group(self, executor: HostExecutor) -> bool:
        """Whether each callback group of an executor has a thread of its own."""
        processor = self.processors.get(executor.name)
        return processor is not None and has_thread_for_each_group(executor, processor.cores)

    def _solve_all(self) -> None:
        host = self.topics.host
        for circle in self.topics.circles():
            for name in circle:
                reason = f"callbacks publish in a circle: {', '.join(sorted(circle))}"
                self.reasons.setdefault(self.topics.executor_of[name].name, reason)
        for executor in host.executors:
            try:
                self.processors[executor.name] = processor_of(executor, host)
                if self._has_windows(executor):
                    length = sum(_most(callback) for callback in executor.callbacks)
                    self.windows[executor.name] = Windows(length)
            except UnknownError as error:
                self.reasons.setdefault(executor.name, str(error))
        limit = 0
        for _ in range(_MAX_PASSES):
            before = self._state()
            for executor in host.executors:
                if executor.name not in self.reasons:
                    self._solve(executor)
            if self._state() == before:
                return
            greatest = {executor.name: self._greatest(executor) for executor in host.executors}
            limit = limit or _MAX_GROWTH * max(greatest.values())
            self.reasons |= {name: _GROWS for name, reached in greatest.items() if reached > limit and name not in self.reasons}
        for executor in host.executors:
            self.reasons.setdefault(executor.name, _GROWS)

    def _has_windows(self, executor: HostExecutor) -> bool:
        """Whether its windows bound latencies: nothing preempts it, and all of its routes begin with timers."""
        processor = self.processors[executor.name]
        is_alone = not processor.higher and not processor.reservations and processor.supply is FULL
        is_suitable = is_alone and executor.works_off_ready_sets(self.topics.host.release)
        return is_suitable and all(self.topics.route(each)[0].period is not None for each in executor.callbacks)

    def _greatest(self, executor: HostExecutor) -> Time:
        """The greatest latency of the callbacks of an executor so far."""
        latencies = (self.latencies.get(callback.name) for callback in executor.callbacks)
        return max((each.worst or 0 for each in latencies if each is not None), default=0)

    def _state(self) -> dict[str, Time | str | None]:
        return {**{name: each.worst for name, each in self.latencies.items()}, **self.reasons}

    def _solve(self, executor: HostExecutor) -> None:
        """The latencies of an executor for the present activations."""
        try:
            if executor.kind is HostExecutorKind.MULTI_THREADED:
                self._solve_threads(executor)
                return
            supply, windows = self.processors[executor.name].supply, self.windows.get(executor.name)
            responses = polled.response_times(self.tasks(executor), self.preempting(executor), supply)
            if windows is not None:
                routes = map(self.topics.route, executor.callbacks)
                responses = {route[-1].name: windows.improved(responses[route[-1].name], route) for route in routes}
            self._use(responses)
        except UnknownError as error:
            self.reasons[executor.name] = str(error)

    def _solve_threads(self, executor: HostExecutor) -> None:
        tasks, cores = self.tasks(executor), self.processors[executor.name].cores
        if executor.name not in self.topics.by_group:
            routes = [self.topics.route(callback) for callback in executor.callbacks]
            self._use(SharedThreads(executor, cores, routes, tasks, self.preempting(executor)).latencies())
            return
        self._use(in_groups(executor, tasks))

    def _use(self, responses: Mapping[str, Response]) -> None:
        self.latencies |= responses
        self.jobs += sum(response.jobs for response in responses.values())
        for response in responses.values():
            if response.worst is None:
                raise UnknownError(response.reason)

    def preempting(self, executor: HostExecutor) -> list[AnalysedTask]:
        """Return the tasks that can preempt the thread of an executor."""
        processor = self.processors[executor.name]
        return [*processor.reservations, *(task for other in processor.higher for task in self.tasks(other))]

    def tasks(self, executor: HostExecutor) -> list[AnalysedTask]:
        """The callbacks of an executor, with the activations of the first callbacks of their routes."""
        if not executor.callbacks:
            return []
        return [self._task(each, self._entering(self.topics.route(each)[0])) for each in executor.callbacks]

    def released(self, executor: HostExecutor) -> list[AnalysedTask]:
        """The callbacks of an executor, with their own activations."""
        return [self._task(each, self.events(each)) for each in executor.callbacks]

    def _task(self, callback: HostCallback, events: EventModel) -> AnalysedTask:
        demand = MultiframeDemand.constant(Ticks(_most(callback)), Ticks(callback.execution.least))
        return AnalysedTask(name=callback.name, events=events, demand=demand)

    def best(self, callback: HostCallback) -> Time:
        """The least time from the release of the first callback of the route to the end of a callback."""
        return sum(each.execution.least for each in self.topics.route(callback))

    def events(self, callback: HostCallback) -> EventModel:
        """The activations of a callback.

        Raises
        ------
        UnknownError : their number has no bound.
        """
        *before, _ = self.topics.route(callback)
        return self.published(before[-1]) if before else self._entering(callback)

    def published(self, callback: HostCallback) -> EventModel:
        """The ends of a callback, at which it publishes.

        Raises
        ------
        UnknownError : their number has no bound.
        """
        response, executor = self.latencies.get(callback.name), self.topics.executor_of[callback.name]
        if executor.name in self.reasons:
            raise UnknownError(self._depends_on(callback, executor))
        entering = self._entering(self.topics.route(callback)[0])
        # Of what was not looked at yet, the least variation is assumed; the iteration continues until all are consistent.
        late = 0 if response is None or response.worst is None else response.worst - self.best(callback)
        return delayed(entering, late)

    def _depends_on(self, callback: HostCallback, executor: HostExecutor) -> str:
        return f"it depends on {callback.name!r} in {executor.name!r}: {self.reasons[executor.name]}"

    def _entering(self, callback: HostCallback) -> EventModel:
        """The activations of a callback that comes first in its executor."""
        if callback.period is not None:
            return PeriodicEvents(callback.period)
        topic, topics = callback.topic or "", self.topics
        sources = [self.published(each) for each in topics.publishers(topic)]
        sources += [topics.from_controller(each) for each in topics.transmissions(topic, Direction.TO_AGENT)]
        latency, described = topics.latency(topic), topics.described.get(topic)
        if not sources and described is not None and described.interval is not None:
            # The jitter is that of the messages in the queue: the times of their publication are unknown.
            return SporadicEvents(described.interval, described.jitter)
        if not sources:
            what = f"neither a callback of the host nor a controller with a 'transport' publishes {topic!r}"
            raise UnknownError(f"{what}; set 'rate' of the topic if it comes from elsewhere")
        if latency.most is None:
            raise UnknownError(f"the latency of the topic {topic!r} is not specified; set 'latency' of it or of the host")
        return aggregated(tuple(delayed(each, latency.most - latency.least) for each in sources))


def _most(callback: HostCallback) -> Time:
    if callback.execution.most is None:
        raise UnknownError(f"the execution time of {callback.name!r} has no maximum")
    return callback.execution.most
