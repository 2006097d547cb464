"""Latencies in a multi-threaded executor, with callback groups of all kinds: the least of the bounds that hold.

1. As if one thread had all the work. While a callback is pending, at least one thread executes: the last one that ends polls when all
   groups are free. So the bound for one thread and any order (`polled`) holds, and no callback starves, if all callbacks together need
   less than one core. Messages overtake each other after a reentrant callback: then only the end of the busy window is known.
2. As chains that share the threads (`reentrant`), if groups do not matter: reentrant ones, and those with callbacks of one chain
   only, of which one alone is pending at a time as long as each chain ends within its period.
3. Group by group, if groups exclude each other and each has a thread of its own: whenever a group is free, a thread is, too, and the
   end of each callback wakes one to poll. So each group is like an executor of one thread.

The steps are proven in docs/proofs/multi-threaded-executor.md. Otherwise a callback can starve (H. Teper et al., "Thread Carefully:
Preventing Starvation in the ROS 2 Multithreaded Executor", 2024).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.host import polled, reentrant
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.host import HostCallback, HostExecutor, HostExecutorKind
from amalthea_uros.timing.event_models.models import PeriodicEvents
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Time

METHOD = "busy window, as if one thread had all callbacks of the executor"
GROUP_METHOD = "busy window, callbacks of a group with a thread of its own in any order"

Route = tuple[HostCallback, ...]


def has_thread_for_each_group(executor: HostExecutor, cores: int) -> bool:
    """Whether there are only groups that exclude each other, and a thread with a core for each."""
    return (
        executor.kind is HostExecutorKind.MULTI_THREADED
        and not any(callback.is_reentrant for callback in executor.callbacks)
        and 1 < executor.threads <= cores
        and len({callback.group for callback in executor.callbacks}) <= executor.threads
    )


def in_groups(executor: HostExecutor, tasks: Sequence[AnalysedTask]) -> dict[str, Response]:
    """The response times of callbacks of which each group has a thread of its own."""
    groups: dict[str, list[AnalysedTask]] = {}
    for callback, task in zip(executor.callbacks, tasks, strict=True):
        groups.setdefault(callback.group, []).append(task)
    responses = dict[str, Response]()
    for group in groups.values():
        responses |= {name: replace(each, method=GROUP_METHOD) for name, each in polled.response_times(group).items()}
    return responses


@dataclass(frozen=True, slots=True)
class SharedThreads:
    """The callbacks of an executor of several threads.

    Attributes
    ----------
    cores : that its threads have; one that is alone may be shared with threads of higher priority
    routes : through which a release reaches each callback, in their order
    tasks : the callbacks, with the activations of the first ones of their routes
    preempting : tasks of higher priority on the only core
    """

    executor: HostExecutor
    cores: int
    routes: Sequence[Route]
    tasks: Sequence[AnalysedTask]
    preempting: Sequence[AnalysedTask] = ()

    def latencies(self) -> Mapping[str, Response]:
        """The latencies of all callbacks since the release of the first one of their routes.

        Raises
        ------
        UnknownError : no method covers the executor.
        """
        reasons, best = [], dict[str, Response]()
        for method in (self._as_one_thread, self._as_chains):
            try:
                responses = method()
            except UnknownError as error:
                reasons.append(str(error))
                continue
            best = {name: min(best.get(name, each), each, key=_worst) for name, each in responses.items()}
        if not best:
            raise UnknownError("; ".join(reasons))
        return best

    def _as_one_thread(self) -> dict[str, Response]:
        responses = polled.response_times(self.tasks, self.preempting)
        for name, route in zip(responses, self.routes, strict=True):
            response = responses[name]
            if response.worst is None:
                raise UnknownError(f"as if one thread had all callbacks: {response.reason}")
            if any(each.is_reentrant for each in route[:-1]):
                response = replace(response, worst=response.window)
            responses[name] = replace(response, method=METHOD)
        return responses

    def _as_chains(self) -> dict[str, Response]:
        if self.preempting:
            raise UnknownError(f"other threads can preempt those of {self.executor.name!r}")
        if self.cores < self.executor.threads:
            raise UnknownError(f"{self.executor.name!r} has more threads than cores, which no published method covers")
        passed = {each.name for route in self.routes for each in route[:-1]}
        ends = [route for route in self.routes if route[-1].name not in passed]
        if sum(map(len, ends)) > len(self.routes):
            raise UnknownError("no published method covers chains that branch in a multi-threaded executor")
        if group := next(self._shared_groups(ends), None):
            raise UnknownError(
                f"callbacks of the group {group!r} can starve, as other chains of it exclude them, and not each group has a thread"
            )
        chains, responses = [self._chain(route) for route in ends], dict[str, Response]()
        for route, response in zip(ends, reentrant.latencies(chains, self.executor.threads), strict=True):
            if response.worst is None:
                raise UnknownError(response.reason)
            responses |= {callback.name: response for callback in route}
        return responses

    def _shared_groups(self, ends: Sequence[Route]) -> Iterator[str]:
        """The groups of which callbacks of different chains exclude each other."""
        chains: dict[str, int] = {}
        for index, route in enumerate(ends):
            for callback in route:
                if not callback.is_reentrant and chains.setdefault(callback.group, index) != index:
                    yield callback.group

    def _chain(self, route: Route) -> reentrant.ReentrantChain:
        by_name = {task.name: task for task in self.tasks}
        events = by_name[route[0].name].events
        if not isinstance(events, PeriodicEvents) or events.jitter:
            raise UnknownError(f"no published method covers the jitter of {route[0].name!r} in a multi-threaded executor")
        demands = [by_name[each.name].demand.worst for each in route]
        return reentrant.ReentrantChain(events.period, sum(demands), demands[-1])


def _worst(response: Response) -> Time:
    return response.worst or 0
