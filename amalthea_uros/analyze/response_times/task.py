"""A process as the methods for response times see it."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models import EventModel
from amalthea_uros.timing.scheduling.ranks import EqualPriority
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """A process on one processor.

    Attributes
    ----------
    events : activations
    priority : higher numbers are served first
    equal_priority : how tasks of the same priority are served; equal for all of them
    deadline : relative to the activation; used by EDF
    slice : length of a time slice; used by round robin
    activation_limit : the number of jobs that can wait at most; further activations are lost
    """

    name: str
    events: EventModel
    demand: MultiframeDemand
    priority: int = 0
    equal_priority: EqualPriority = EqualPriority.FIFO
    deadline: Time = 0
    slice: Time = 0
    activation_limit: int = 1
