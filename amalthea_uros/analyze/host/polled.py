"""Response times in an executor of one thread, whatever the order of its callbacks.

After D. Casini, T. Blass, I. Luetkebohle and B. B. Brandenburg, "Response-time analysis of ROS 2 processing chains under
reservation-based scheduling", ECRTS 2019. A job that is released `a` after the start of a busy window ends within it at the least x
with

    supply(x) = own jobs released up to a + jobs of the others released before it starts, at x - C at the latest

which only needs that the executor is never idle while a callback is pending, and that callbacks do not preempt each other. So it
holds for the single-threaded, the static and the events executor of all distributions. Its bound for timers that are looked at
before each callback only holds up to dashing, and is not used. Threads that preempt the executor interfere up to x, as tasks of
higher priority do.

If the tasks have the activations of the callbacks with which their chains enter the executor, response times begin with these: the
bound of the paper for chains.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, unbounded
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "busy window, callbacks of an executor in any order"
SOURCE = "Casini, Blass, Luetkebohle, Brandenburg 2019"


def response_times(
    tasks: Sequence[AnalysedTask], higher: Sequence[AnalysedTask] = (), supply: Supply = FULL
) -> dict[str, Response]:
    """The response times of all callbacks of an executor, by name.

    Parameters
    ----------
    higher : the callbacks of threads that preempt the executor
    """
    if not tasks:
        return {}
    *_, before_last, every = Interference.of_first([*higher, *tasks], supply)
    if before_last.overloads_with(tasks[-1]):
        return {task.name: unbounded(task.demand.best, before_last, tasks[-1], METHOD, SOURCE) for task in tasks}
    busy = _BusyWindow(Interference.of(tasks), Interference.of(higher), supply, every.window(0, 0))
    return {task.name: busy.response_time(task) for task in tasks}


@dataclass(frozen=True, slots=True)
class _BusyWindow:
    """The longest busy window of an executor; None if it does not end.

    Attributes
    ----------
    callbacks : the interference of all its callbacks
    higher : that of the threads that preempt it
    """

    callbacks: Interference
    higher: Interference
    supply: Supply
    length: Time | None

    def response_time(self, task: AnalysedTask) -> Response:
        """The response time of a callback."""
        best, length = task.demand.best, self.length
        if length is None or task.events.eta_plus(length) > max_jobs(task):
            reason = "its busy window is too long: the callbacks need nearly all of the core"
            return Response(worst=None, best=best, method=METHOD, source=SOURCE, reason=reason)
        end, worst, jobs = 0, 0, 0
        for after in releases(task, length):
            # All of them end within the busy window, except that jobs that take no time can wait for those released at its end.
            if task.demand.worst and length - after <= worst:
                break
            jobs += 1
            if worst and self._served(task, after, after + worst) <= after + worst:
                continue
            reached = self._end(task, after, end)
            if reached is None:
                reason = "its busy window does not end"
                return Response(worst=None, best=best, method=METHOD, source=SOURCE, reason=reason)
            end, worst = reached, max(worst, reached - after)
        return Response(worst=worst, best=best, method=METHOD, source=SOURCE, claim=Claim.BOUND, jobs=jobs, window=length)

    def _end(self, task: AnalysedTask, after: Time, before: Time) -> Time | None:
        """The latest end of the last job that is released up to `after`, from the start of the busy window.

        Parameters
        ----------
        before : the end of an earlier job, which is not later, as the demand up to each moment is not greater
        """
        end = max(after + 1, before)
        for _ in range(MAX_STEPS):
            reached = self._served(task, after, end)
            if reached <= end:
                return end
            if reached > LIMIT:
                return None
            end = reached
        return None

    def _served(self, task: AnalysedTask, after: Time, end: Time) -> Time:
        """When the last job that is released up to `after` has ended, with everything before it, unless it ends before `end`."""
        own = task.demand.max_demand(task.events.eta_plus(after + 1))
        others = self._of_others(task, end - task.demand.worst + 1)
        return self.supply.time_for(own + others + self.higher.in_window(end))

    def _of_others(self, task: AnalysedTask, window: Time) -> Time:
        """The demand of the other callbacks in a window, from that of all, so that all callbacks share one interference."""
        return self.callbacks.in_window(window) - task.demand.max_demand(task.events.eta_plus(window))


def releases(task: AnalysedTask, window: Time) -> Iterator[Time]:
    """The earliest releases of the jobs in a busy window, each once: of jobs that can be released together, the last one counts."""
    every = map(task.events.delta_min, range(1, task.events.eta_plus(window) + 1))
    return (release for release, _ in groupby(every))
