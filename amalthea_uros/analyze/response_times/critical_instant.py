"""Response times that are certain to occur, because the worst case of the busy window is one of the behaviours of the system.

C. L. Liu and J. W. Layland, "Scheduling algorithms for multiprogramming in a hard-real-time environment", Journal of the ACM 20(1),
1973: under fixed priorities the worst case is a release together with all tasks of higher priority. Sporadic activations can come
together. Activations on a grid can if their latest releases coincide somewhere, which is so if they are congruent modulo the greatest
common divisor of each two periods. A task of lower priority can be in its longest stretch since one unit of time if nothing else has
to be activated before.

A bound that is beyond a deadline leaves open whether the deadline is missed; such a response time decides it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations
from math import gcd

from amalthea_uros.analyze.response_times import fixed_priority, non_preemptive
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.perf.distributions import highest
from amalthea_uros.perf.software import Preemption
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic
from amalthea_uros.timing.event_models.models import SporadicEvents
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, ScheduledProcess, is_preemptive, preemption
from amalthea_uros.units import Time


def certain_response(name: str, solution: Solution) -> Time | None:
    """A response time that some job of a process has, in picoseconds; None if it is not certain, or not bounded."""
    context = solution.context
    item = context.scheduled[name]
    served = context.served(item.core, None)
    here = [other for other in served if isinstance(other, ScheduledProcess)]
    if len(here) < len(served) or context.decisions or context.has_loops_or_waits(item.core) or not _is_plain(here, solution):
        return None
    above = [other for other in here if other.rank > item.rank]
    if not _can_come_together([item, *above], solution):
        return None
    time_base = context.demand_model.time_base(item.core)
    wait = Blocking.of(here, solution).time(item)
    if wait and not all(_is_free(other, solution) for other in here):
        # The other releases may leave no moment at which somebody of lower priority is just ahead; but it can do without.
        wait = 0
    task, *higher = [AnalysedTask.of(other, solution) for other in (item, *above)]
    if is_preemptive(item):
        worst = fixed_priority.response_time(task, Interference.of(higher), max(0, wait - 1))[0].worst
    else:
        worst = non_preemptive.response_time(task, higher, max(0, wait - 1)).worst
    return None if worst is None else worst // time_base


def _is_plain(here: Sequence[ScheduledProcess], solution: Solution) -> bool:
    """Whether all processes of a core are known, of distinct ranks, and all preemptive with ceilings, or all not preemptive."""
    context = solution.context
    core = here[0].core
    if not solution.is_closed(core) or context.open_semaphores:
        return False
    return (
        all(solution.is_analysable(item.name) and item.equal_priority is EqualPriority.FIFO for item in here)
        and all(frame.is_always for item in here for frame in context.demands[item.name].frames)
        and len({item.rank for item in here}) == len(here)
        and keep_off_alike(here)
    )


def keep_off_alike(here: Sequence[ScheduledProcess]) -> bool:
    """Whether all processes are preemptive, apart from critical sections, or none is."""
    return all(map(is_preemptive, here)) or all(
        preemption(item) is Preemption.NON_PREEMPTIVE and item.group is None for item in here
    )


def _can_come_together(items: Iterable[ScheduledProcess], solution: Solution) -> bool:
    grids: list[tuple[Time, Time]] = []
    stimuli = solution.context.system.stimuli_by_name
    for item in items:
        match [stimuli.get(name) for name in item.process.stimuli]:
            case [Periodic(condition=None, min_distance=None) as stimulus]:
                delay = 0 if stimulus.jitter is None else highest(stimulus.jitter)
                if delay is None:
                    return False
                grids.append((stimulus.offset + delay, stimulus.period))
            case [RelativePeriodic(condition=None)] if _is_free(item, solution):
                pass
            case _:
                return False
    return all((one - other) % gcd(period, length) == 0 for (one, period), (other, length) in combinations(grids, 2))


def _is_free(item: ScheduledProcess, solution: Solution) -> bool:
    """Whether a process can stay away for any time."""
    events = solution.event_models[item.name]
    return isinstance(events, SporadicEvents) and events.longest is None
