"""The execution demand of the parts of an iteration, in the time base of the core.

The iteration begins with the overhead of the executor, which fills the wait set before the wait and checks all handles after it. How
much of it comes before the wait is not known, so it counts wherever a part of it can be.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Activity, Call
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.units import Interval, Time

_NONE = Interval(Time(0), Time(0))


@dataclass(frozen=True, slots=True, kw_only=True)
class IterationDemand:
    """The parts of an iteration.

    Attributes
    ----------
    spin : overhead of every iteration
    takes, callbacks : by the names of handles
    after : what the thread waits for without sleeping, after the callbacks
    """

    spin: Interval[Time]
    takes: Mapping[str, Interval[Time]]
    callbacks: Mapping[str, Interval[Time]]
    after: Interval[Time] = _NONE

    @classmethod
    def of(cls, executor: Executor, context: TimingContext) -> IterationDemand:
        """The parts of an iteration of an executor.

        Raises
        ------
        UnknownError : some demand is unknown; the text says why.
        """
        scheduled = context.scheduled.get(executor.task)
        if scheduled is None:
            raise UnknownError(
                context.reasons.get(executor.task, f"its task {executor.task!r} is not allocated to a scheduler")
            )
        process, core = scheduled.process, scheduled.core

        def demand(activities: Iterable[Activity]) -> Interval[Time]:
            found = context.demand_model.of_activities(process, tuple(activities), core)
            return Interval(found.best, found.worst)

        def calls(*names: str | None) -> Interval[Time]:
            return demand(Call(runnable=name) for name in names if name is not None)

        spin, handles = calls(executor.spin), executor.handles
        # What a job executes besides its activities, such as copies of labels, can be anywhere in it.
        beside = context.demand_model.of_process(process, core).worst - demand(process.activities).upper
        # Calls that no handle has are overhead of the operating system around the iteration.
        own = {
            executor.spin,
            executor.poll,
            executor.busy_wait,
            *(name for handle in handles for name in (handle.take, handle.runnable)),
        }
        foreign = demand(each for each in process.activities if isinstance(each, Call) and each.runnable not in own)
        return cls(
            spin=Interval(spin.lower, spin.upper + max(0, beside) + foreign.upper),
            takes={handle.name: _taking(handle, calls(handle.take)) for handle in handles},
            callbacks={handle.name: calls(handle.runnable) for handle in handles},
            after=calls(executor.busy_wait),
        )

    def of_handle(self, handle: Handle) -> Interval[Time]:
        """Taking the message and calling back."""
        take, callback = self.takes[handle.name], self.callbacks[handle.name]
        return Interval(take.lower + callback.lower, take.upper + callback.upper)


def _taking(handle: Handle, demand: Interval[Time]) -> Interval[Time]:
    """What taking a message demands: a callback that is always called can be called without one."""
    return Interval(Time(0), demand.upper) if handle.always else demand
