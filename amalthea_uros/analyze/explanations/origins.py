"""Why a response time has no bound: the processes from which that comes, and what would give them one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from amalthea_uros.analyze.explanations.execution_shares import execution_shares
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.perf.activities import Loop, WaitEvent, walk
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess


class OriginKind(StrEnum):
    """What is missing."""

    MAPPING = "mapping"
    DEMAND = "demand"
    ACTIVATION = "activation"
    OVERLOAD = "overload"
    OTHER = "other"


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """A process from which it comes that a response time has no bound.

    Attributes
    ----------
    remedy : what would give it a bound, as an imperative; "" if there is no general advice
    """

    process: str
    kind: OriginKind
    reason: str
    remedy: str


_REMEDIES = {
    OriginKind.MAPPING: "Map it to a scheduler or interrupt controller that is responsible for one core with a known clock.",
    OriginKind.ACTIVATION: "Give it a stimulus with a period, or with a minimum time between two activations.",
    OriginKind.OVERLOAD: "Shorten execution times, lengthen periods, or move processes to another core.",
}


def origins(solution: Solution, name: str) -> list[Origin]:
    """The processes from which it comes that the response time of a process has no bound; nothing if it has one."""
    return list(_OriginSearch(solution, set()).of(name))


@dataclass(frozen=True, slots=True)
class _OriginSearch:
    """Follows the dependencies of processes without a bound; each is visited once."""

    solution: Solution
    visited: set[str]

    @property
    def context(self) -> TimingContext:
        return self.solution.context

    def of(self, name: str) -> Iterator[Origin]:
        response = self.solution.responses.get(name)
        if name in self.visited or (response is not None and response.worst is not None):
            return
        self.visited.add(name)
        if response is not None:
            yield self._origin(name, OriginKind.OVERLOAD if response.is_overload else OriginKind.OTHER, response.reason)
            return
        reason = self.solution.reasons.get(name, "it was not analysed")
        scheduled = self.context.scheduled.get(name)
        if scheduled is None:
            yield self._origin(name, OriginKind.MAPPING, reason)
        elif name not in self.context.demands:
            yield self._origin(name, OriginKind.DEMAND, reason)
        else:
            others = self._triggering(scheduled) if name not in self.solution.event_models else self._preceding(scheduled)
            found = [origin for other in others for origin in self.of(other)]
            is_inactive = name not in self.solution.event_models
            yield from found or [self._origin(name, OriginKind.ACTIVATION if is_inactive else OriginKind.OTHER, reason)]

    def _triggering(self, scheduled: ScheduledProcess) -> Iterator[str]:
        """The processes that activate a process."""
        for stimulus in scheduled.process.stimuli:
            for position in self.context.dataflow.fired_at(stimulus):
                yield position.process.name

    def _preceding(self, scheduled: ScheduledProcess) -> Iterator[str]:
        """The processes of the same or a higher rank on its core, or of unknown rank, and those that can block it."""
        touching = self.context.touching
        yield from touching.intruders(scheduled.core)
        yield from touching.by_semaphores(scheduled.name)
        for other in self.context.on_core(scheduled.core):
            if other.name != scheduled.name and (other.rank >= scheduled.rank or not self.solution.is_analysable(other.name)):
                yield other.name

    def _origin(self, name: str, kind: OriginKind, reason: str) -> Origin:
        remedy = self._demand_remedy(name) if kind is OriginKind.DEMAND else _REMEDIES.get(kind, "")
        return Origin(process=name, kind=kind, reason=reason, remedy=remedy)

    def _demand_remedy(self, name: str) -> str:
        """What makes the execution time of a process known."""
        activities = list(walk(self.context.scheduled[name].process.activities))
        if any(isinstance(each, WaitEvent) for each in activities):
            return "Trigger a separate task instead of waiting for the event."
        unknown = [share.name for share in execution_shares(self.context, name) if share.time is None and share.is_runnable]
        if any(isinstance(each, Loop) for each in activities):
            return "State how often its loops iterate at most."
        what = " and ".join(map(repr, unknown)) or "it"
        return f"State the execution time of {what}."
