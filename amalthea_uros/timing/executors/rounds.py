"""The execution demand of the parts of a round, in the time base of the core.

The round begins with the overhead of the executor, which fills the wait set before the wait and checks all handles after it. How much
of it comes before the wait is not known, so it counts wherever a part of it can be.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.perf.software import Process
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.notes import UnknownDemandError
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class Cost:
    """The least and the greatest execution demand of something."""

    best: Time
    worst: Time


@dataclass(frozen=True, slots=True, kw_only=True)
class RoundCosts:
    """The parts of a round.

    Attributes
    ----------
    spin : overhead of every round
    takes, callbacks : by the names of handles
    """

    spin: Cost
    takes: Mapping[str, Cost]
    callbacks: Mapping[str, Cost]

    def of(self, handle: Handle) -> Cost:
        """Taking the message and calling back."""
        take, callback = self.takes[handle.name], self.callbacks[handle.name]
        return Cost(take.best + callback.best, take.worst + callback.worst)


def round_costs(executor: Executor, context: TimingContext) -> RoundCosts:
    """The parts of a round of an executor.

    Raises
    ------
    UnknownDemandError : some demand is unknown; the text says why.
    """
    scheduled = context.scheduled.get(executor.task)
    if scheduled is None:
        raise UnknownDemandError(
            context.reasons.get(executor.task, f"its task {executor.task!r} is not allocated to a scheduler")
        )
    process, core = scheduled.process, scheduled.core
    spin = _cost(executor.spin, process, core, context)
    beside = context.demand_model.of_process(process, core).worst - _of_activities(process, core, context)
    return RoundCosts(
        # What a job executes besides its activities, such as copies of labels, can be anywhere in it; that of others is overhead.
        spin=Cost(spin.best, spin.worst + max(0, beside) + _of_others(executor, process, core, context)),
        takes={
            handle.name: Cost(0, 0) if handle.take is None else _cost(handle.take, process, core, context)
            for handle in executor.handles
        },
        callbacks={handle.name: _cost(handle.runnable, process, core, context) for handle in executor.handles},
    )


def _of_activities(process: Process, core: str, context: TimingContext) -> Time:
    return context.demand_model.of_activities(process, process.activities, core).worst


def _of_others(executor: Executor, process: Process, core: str, context: TimingContext) -> Time:
    """What the task calls around the round: overhead of the operating system, which no handle has."""
    own = {executor.spin, *(name for handle in executor.handles for name in (handle.take, handle.runnable))}
    others = [activity for activity in process.activities if isinstance(activity, Call) and activity.runnable not in own]
    return context.demand_model.of_activities(process, others, core).worst


def _cost(runnable: str, process: Process, core: str, context: TimingContext) -> Cost:
    demand = context.demand_model.of_activities(process, [Call(runnable=runnable)], core)
    return Cost(demand.best, demand.worst)
