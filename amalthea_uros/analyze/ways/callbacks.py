"""The hops at callbacks of executors that loop.

A message waits for the rest of the running round, a sleep, messages before it and callbacks before its own; the analysis of executors
bounds this as the response time of the callback. What reads data instead waits for its next run: a timer is due within its period at
the latest, so that the data wait at most that long before the timer becomes due. If it was due already, its call comes even earlier:
either before the data, then the next grid point counts, or after them, with the data.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from amalthea_uros.analyze.ways.stations import Callback
from amalthea_uros.executors.results import ExecutorResult, HandleResult, Hop, HopKind, Part
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class CallbackHops:
    """The hops at the callbacks of executors.

    Attributes
    ----------
    executors : the results of all executors that loop
    jitter : of the arrivals at handles, by name, besides what is stated; None if it is unknown
    """

    executors: Sequence[ExecutorResult]
    jitter: Mapping[str, Time | None]

    def response(self, station: Callback) -> Hop:
        """From the arrival of a message, or from when a timer is due, to the end of the callback."""
        name, executor = station.handle.name, station.executor.name
        found = self._result(station)
        bounds = found.response
        if bounds.worst is None:
            return Hop(
                kind=HopKind.EXECUTOR,
                name=executor,
                best=bounds.best,
                worst=None,
                source="",
                reason=f"the response time of {name!r} in {executor!r} has no bound: {bounds.reason or 'it was not analysed'}",
                remedy=f"See the results of the executor {executor!r}.",
            )
        return Hop(
            kind=HopKind.EXECUTOR,
            name=executor,
            best=bounds.best,
            worst=bounds.worst,
            source=f"response time of {name}: {bounds.method} ({bounds.source})",
            parts=tuple(Part(name=each.name, least=each.least, most=each.most, why=each.why) for each in found.terms),
        )

    def loss(self, station: Callback) -> str:
        """How messages of a callback can be lost; "" if none can."""
        lost, name = self._result(station).lost, station.handle.name
        return "" if lost is None else f"{lost.what} of {name!r} can be lost: {lost.sequence}"

    def sampling(self, station: Callback) -> Hop:
        """From a write of data that a callback reads to the end of the callback that reads them, or newer ones."""
        response, interval, reason = self.response(station), self._longest_interval(station), self._why_irregular(station)
        if response.worst is None:
            return replace(response, kind=HopKind.SAMPLING, best=0)
        handle = station.handle
        if interval is None or reason:
            return Hop(
                kind=HopKind.SAMPLING,
                name=station.executor.name,
                best=0,
                worst=None,
                source="",
                reason=reason or f"the time between two messages of {handle.name!r} has no maximum",
                remedy=f"Read the data in a timer callback, or let the path begin with the topic of {handle.name!r}.",
            )
        wait = Part(name=f"until {handle.name} is due next", least=0, most=interval, why="the data came just after it was due")
        return replace(
            response,
            kind=HopKind.SAMPLING,
            # It can have been called already, and read the data at its very end.
            best=0,
            worst=interval + response.worst,
            source=f"period and response time of {handle.name}",
            parts=(wait, *(response.parts or (Part(name=f"response time of {handle.name}", least=0, most=response.worst),))),
        )

    def _result(self, station: Callback) -> HandleResult:
        executor = next(each for each in self.executors if each.name == station.executor.name)
        return executor.handles[station.handle.name]

    def _longest_interval(self, station: Callback) -> Time | None:
        """The maximum time between two nominal arrivals, or expirations; None if there is none."""
        handle = station.handle
        if handle.kind is HandleKind.TIMER:
            return handle.interval
        jitter = self.jitter.get(handle.name, 0)
        if handle.interval is None or jitter is None or not handle.is_periodic:
            return None
        return handle.interval + handle.jitter + jitter

    def _why_irregular(self, station: Callback) -> str:
        """Why the next message of a callback can come at any time; "" for timers, whose grid goes on when periods are missed."""
        return "" if station.handle.kind is HandleKind.TIMER else self.loss(station)
