"""How long the thread of an executor needs to execute something, with preemption by others, blocking and suspensions.

Let the thread become ready at t1 and end at t2, executing C in between, suspended for S in all, and resumed n times, at t1 included.
Let t0 be the last time until t1 at which no process of at least its rank is pending. At every moment from t0 to t2 the core executes
one of these, all of whose jobs were activated since t0; or the thread; or the thread is suspended; or a process of lower rank keeps
others off, which can happen once after each resumption, because then either the thread or a process of higher rank follows. So t2 -
t1 is at most the least w with

    w = S + n B + C + P + sum over the others of C_j(eta_j(w))

(the busy window of `response_times.fixed_priority`, in which suspensions count like execution). If the thread itself keeps others off,
what it still executed before it was suspended can delay them, and then count as blocking. P is the demand of the jobs of equal rank,
and of lower ranks that count as others, that can be pending at t1: they waited while the thread executed, and go first when it is
suspended.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.errors import UnknownError
from amalthea_uros.timing.basics.time_base import Ticks
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.solution import Solution


@dataclass(frozen=True, slots=True)
class ExecutorThread:
    """The processor as the thread of an executor sees it; execution demands are in its time base, times in picoseconds."""

    others: Interference
    blocking: Time
    waiting: Time
    time_base: int

    @classmethod
    def of(cls, task: str, solution: Solution) -> ExecutorThread:
        """The processor as the thread of a task sees it.

        Raises
        ------
        UnknownError : it is not scheduled, or something unknown can delay it.
        """
        context = solution.context
        scheduled = context.scheduled.get(task)
        if scheduled is None:
            raise UnknownError(context.reasons.get(task, "its task is not allocated to a scheduler"))
        here = context.served(scheduled.core, scheduled.server)
        processes = [item for item in here if isinstance(item, ScheduledProcess)]
        if scheduled.server is not None or len(processes) < len(here):
            raise UnknownError("its core is shared by servers with budgets, which is not supported for executors in loops")
        blocking = Blocking.of(processes, solution)
        level = blocking.level(scheduled)
        # One executor of a thread follows the other.
        own_thread = context.system.tasks_of_thread(task)
        above = [item for item in processes if item.rank >= level.rank and item.name not in own_thread]
        unknown = solution.intruder(scheduled.core, above_isrs=False) or next(
            (item.name for item in above if not solution.is_analysable(item.name)), ""
        )
        if unknown:
            raise UnknownError(f"{unknown!r}, which could not be analysed, can preempt it")
        if blocking.unknown and (keeping := blocking.obstacle(scheduled)):
            raise UnknownError(f"{keeping!r}, which could not be analysed, can block it")
        own = (
            context.demand_model.of_process(scheduled.process, scheduled.core).worst
            if blocking.keeps_off_others(scheduled)
            else 0
        )
        time_base = context.time_base(task)
        return cls(
            Interference.of(
                [*(AnalysedTask.of(item, solution) for item in above), *AnalysedTask.of_decisions(scheduled.core, solution)]
            ),
            blocking.time(scheduled) + own,
            sum(_waiting(item, solution) for item in above if item.rank <= scheduled.rank),
            time_base,
        )

    def time(self, demand: Time, suspended: Time | None = 0, resumed: int = 1) -> Time | None:
        """The longest time to execute a demand; None if it is not bounded.

        Parameters
        ----------
        suspended : maximum time of all suspensions; None if it is not known
        resumed : how often it can become ready, the first time included
        """
        if suspended is None:
            return None
        fixed = suspended * self.time_base + resumed * self.blocking + self.waiting + demand
        if not fixed and not self.others.task_count:
            return 0
        found = self.others.window(fixed, 0)
        return None if found is None else -(-found // self.time_base)


def _waiting(item: ScheduledProcess, solution: Solution) -> Ticks:
    """The demand of the jobs of a process that can be pending at a time; a thread that loops has one iteration at most."""
    if any(executor.task == item.name for executor in solution.context.system.executors):
        count = 1
    else:
        response, limit = solution.responses.get(item.name), getattr(item.process, "activation_limit", None)
        bounds = [limit] if limit is not None else []
        if response is not None and response.worst is not None:
            bounds.append(solution.event_models[item.name].eta_plus(response.worst))
        if not bounds:
            raise UnknownError(f"the number of pending jobs of {item.name!r}, which has the same priority, is unknown")
        count = min(bounds)
    return solution.context.demands[item.name].max_demand(count)
