"""The response times of a system with their timing context; chains and explanations are based on it."""

from __future__ import annotations

from dataclasses import dataclass, field

from amalthea_uros.analyze.results import Response
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models import EventModel
from amalthea_uros.units import Time


@dataclass(slots=True)
class Solution:
    """Consistent response times and activations of all processes.

    Attributes
    ----------
    event_models : activations, by the names of processes
    reasons : why the response time of a process is unknown
    """

    context: TimingContext
    event_models: dict[str, EventModel] = field(default_factory=dict)
    responses: dict[str, Response] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)

    def mark_unknown(self, name: str, reason: str) -> None:
        """Record why the response time of a process is unknown."""
        self.reasons.setdefault(name, reason)

    def is_known(self, name: str) -> bool:
        """Whether demand and activations of a process are known."""
        return name in self.context.demands and name in self.event_models

    def is_analysable(self, name: str) -> bool:
        """Whether also the critical sections of a process are known."""
        return self.is_known(name) and name not in self.context.unclear_locks

    def bcet(self, name: str) -> Time:
        """Best-case execution time of a process, in picoseconds; 0 if it is unknown."""
        demand = self.context.demands.get(name)
        return 0 if demand is None else demand.best // self.context.time_base(name)
