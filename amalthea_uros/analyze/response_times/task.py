"""What the response-time analyses know of a process, and what they tell of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from amalthea_uros.timing.event_models.base import Arrivals
from amalthea_uros.timing.multiframe import Cost
from amalthea_uros.units import Time


class Sharing(StrEnum):
    """Who of the same priority is served first."""

    ARRIVAL = "first come, first served"
    DEADLINE = "earliest deadline first"
    SLICES = "round robin"


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """A process on one processor.

    Attributes
    ----------
    priority : higher numbers are served first
    sharing : how it shares its priority with others; all of them do it in the same way
    deadline : relative to the arrival, for the earliest deadline first
    slice : how long it is served at a time, for round robin
    """

    name: str
    arrivals: Arrivals
    cost: Cost
    priority: int = 0
    sharing: Sharing = Sharing.ARRIVAL
    deadline: Time = 0
    slice: Time = 0


class Claim(StrEnum):
    """What a number claims."""

    EXACT = "exact"
    BOUND = "bound"
    OBSERVED = "observed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Response:
    """The response time of a task, from its arrival to its end.

    Attributes
    ----------
    worst : None if there is no finite bound, and then `reason` says why
    best : least response time that is possible
    jobs : how many jobs of the busy window were looked at
    window : length of the busy window up to the end of the worst job
    completions : when its jobs end at the latest, from its start; empty if that is not known
    terms : what the worst case is made of: own, interference, blocking; it is their sum
    """

    worst: Time | None
    best: Time
    method: str
    source: str
    claim: Claim = Claim.EXACT
    jobs: int = 1
    window: Time = 0
    completions: tuple[Time, ...] = ()
    terms: Mapping[str, Time] = field(default_factory=dict)
    reason: str = ""
