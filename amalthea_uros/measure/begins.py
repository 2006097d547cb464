"""With which events things of a model begin that traces show, so that what is measured is what the model says of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.trace.table import EventKind

#: With which event of a job a chain begins; a text says why traces do not show it, and then it is not measured.
ChainBegin: TypeAlias = "EventKind | str"
ACTIVATION = "activation"
#: With what jobs and chains begin, in words.
BEGINS = {EventKind.ACTIVATE: ACTIVATION, EventKind.START: "start"}
#: The same of a chain that begins with its first step, and not with the job that makes it.
FIRST_STEP = "first step"
#: The same of an iteration of an executor that spins in a loop: its job begins with a wait for messages.
END_OF_WAIT = "end of the wait"
#: The quantities of jobs that begin at the activation.
FROM_ACTIVATION = frozenset(
    (JobMetric.RESPONSE_TIME, JobMetric.INITIAL_PENDING_TIME, JobMetric.PREEMPTION_TIME, JobMetric.ACTIVATE_TO_ACTIVATE)
)


def begin_name(event: EventKind) -> str:
    """With what a chain begins, in words."""
    return BEGINS.get(event, FIRST_STEP)


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelBegins:
    """With which events things of a model begin.

    Attributes
    ----------
    chains : by default, a chain begins with the activation of the job that makes its first step
    iterations : the tasks of executors that spin in loops -> what activates their jobs in a simulation, at the begin of a wait for
        messages; an iteration begins when that wait is over
    callbacks : that these executors call: what they respond to, a message or a timer, is no event of a trace
    """

    chains: Mapping[str, ChainBegin] = field(default_factory=dict)
    iterations: Mapping[str, str] = field(default_factory=dict)
    callbacks: frozenset[str] = frozenset()
