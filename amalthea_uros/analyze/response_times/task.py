"""A process as the methods for response times see it, and the supply of its core: all of its time, or the budget of a server.

The supply of a server is bounded as that of a periodic resource (I. Shin and I. Lee, "Periodic resource model for compositional
real-time guarantees", RTSS 2003; R. I. Davis and A. Burns, "Hierarchical fixed priority pre-emptive scheduling", RTSS 2005).
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.derived import rescaled
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, ScheduledProcess, StatedPlace
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.solution import Solution


@dataclass(frozen=True, kw_only=True)
class AnalysedTask:
    """A process on one processor.

    Attributes
    ----------
    events : activations
    priority : higher numbers are served first
    equal_priority : how tasks of the same priority are served; equal for all of them
    place : among those of the same priority, if their order is known in part
    deadline : relative to the activation; used by EDF
    slice : length of a time slice; used by round robin
    is_alone : whether each job is activated only after the one before it has executed all of its demand
    activation_limit : the number of jobs that can wait at most; further activations are lost
    """

    name: str
    events: EventModel
    demand: MultiframeDemand
    priority: int = 0
    equal_priority: EqualPriority = EqualPriority.FIFO
    place: StatedPlace | None = None
    deadline: Time = 0
    slice: Time = 0
    activation_limit: int = 1
    is_alone: bool = False

    @cached_property
    def demand_rate(self) -> Fraction:
        """Maximum demand per time in the long run."""
        return self.demand.mean_worst * self.events.rate

    @cached_property
    def approximate_demand_rate(self) -> float:
        """The demand rate as a float, which is faster."""
        if isinstance(self.events, PeriodicEvents):
            return sum([frame.worst / frame.prescaler for frame in self.demand.frames]) / self.events.period
        return float(self.demand_rate)

    @classmethod
    def of(cls, item: ScheduledProcess, solution: Solution) -> AnalysedTask:
        """A scheduled process, in the time base of its core."""
        return cls(
            name=item.name,
            events=rescaled(solution.event_models[item.name], solution.context.time_base(item.name)),
            demand=solution.context.demands[item.name],
        )

    @classmethod
    def of_decisions(cls, core: str, solution: Solution, priority: int = 0) -> list[AnalysedTask]:
        """The decisions of schedulers at activations of tasks on a core, which precede everything else."""
        context = solution.context
        return [
            cls(
                name=f"decision for {item.name}",
                events=rescaled(solution.event_models[item.name], context.time_base(item.name)),
                demand=context.decisions[item.name],
                priority=priority,
            )
            for item in context.on_core(core)
            if item.name in context.decisions and item.name in solution.event_models
        ]


@dataclass(frozen=True, slots=True, kw_only=True)
class Supply:
    """A budget in each period.

    Attributes
    ----------
    wait : maximum time without supply before the first budget
    is_needed_at_end : whether jobs can have accesses left once their demand is served: these take no time, but where a budget ends
        just then, they wait for the next one
    """

    budget: Time
    period: Time
    wait: Time
    is_needed_at_end: bool = False

    @property
    def rate(self) -> Fraction:
        """Share of the core in the long run."""
        return Fraction(self.budget, self.period)

    def time_for(self, demand: Time) -> Time:
        """Maximum time until the demand has been served; each further budget that is needed adds a gap."""
        if demand <= 0:
            return 0
        gaps = demand // self.budget if self.is_needed_at_end else -(-demand // self.budget) - 1
        return self.wait + gaps * (self.period - self.budget) + demand


#: All of the time of a core.
FULL = Supply(budget=1, period=1, wait=0)
