"""Best-case response times of processes whose releases are known relative to those of more important ones.

Let J be a job that is released at r and ends at e, and H the processes with known releases each of which preempts it at once and
delays it until its own end (`Blocking.interrupts`). Then e - r is at least what J executes, and what all jobs of H execute that are
released in [r, e):

1. A job of H that is released at a time t in [r, e) is pending from then on, and no other reason makes it wait for J.
2. From t on until it ends, J does not execute. J ends at e, and executes right before that. So the job of H has ended by e.
3. It has executed in [t, e) then, and J has executed in [r, e). On one core these times do not overlap.

So e is at least the least fixed point of e = r + C + sum over H of C_j * (releases of j in [r, e)), with best-case execution times:
the right side is not greater for an earlier e, so that no e below that fixed point can satisfy the inequality. It is computed for each
release r, from the first one on until all releases repeat; the minimum over them bounds all jobs. It counts whole jobs of H at their
known places, where O. Redell and M. Sanfridson, ECRTS 2002, count only those that no phase can avoid.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import lcm

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.response import Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time

#: Releases of a process that are examined; with more until they repeat, its best case stays as it is.
MAX_RELEASES = 3000


def raised(core: str, solution: Solution) -> Mapping[str, Response]:
    """The responses on a core of which known releases raise the best case, in picoseconds."""
    context = solution.context
    here = [item for item in context.served(core, None) if isinstance(item, ScheduledProcess)]
    # Where schedulers take time to decide, a process is not ready at its release.
    if context.decisions or context.has_loops_or_waits(core) or len(here) < len(context.served(core, None)):
        return {}
    if not all(solution.is_analysable(item.name) for item in here):
        return {}
    released = {item.name: jobs for item in here if (jobs := _certain(item, solution)) is not None}
    blocking, time_base = Blocking.of(here, solution), context.demand_model.time_base(core)
    responses: dict[str, Response] = {}
    for item in here:
        if item.name not in released:
            continue
        above = [released[other.name] for other in here if other.name in released and blocking.interrupts(other, item)]
        response, best = solution.responses[item.name], _best(released[item.name], above, time_base)
        if best is not None and best // time_base > response.best:
            responses[item.name] = replace(response, best=best // time_base)
    return responses


@dataclass(frozen=True, slots=True)
class _CertainJobs:
    """Jobs that are released at offset + k * period for certain, each of which executes at least a demand."""

    releases: Periodic
    demand: Time

    def before(self, time: Time) -> int:
        """The number of releases before a time, which is in picoseconds."""
        return max(0, -(-(time - self.releases.offset) // self.releases.period))


def _certain(item: ScheduledProcess, solution: Solution) -> _CertainJobs | None:
    """The jobs of a process; None if not all of its activations are known and lead to a job that ends before the next one."""
    releases, response = known_releases(item.process, solution.context.system), solution.responses.get(item.name)
    if releases is None or response is None or response.worst is None or response.worst > releases.period:
        return None
    return _CertainJobs(releases, _least(solution.context.demands[item.name]))


def _least(demand: MultiframeDemand) -> Time:
    """The demand that every job executes at least, also the first ones."""
    return sum(frame.best for frame in demand.frames if frame.is_always)


def _best(own: _CertainJobs, above: Sequence[_CertainJobs], time_base: int) -> Time | None:
    """The minimum over all releases in the time base; None if they are too many."""
    period, offset = own.releases.period, own.releases.offset
    until = max(each.releases.offset for each in (own, *above)) + lcm(period, *(each.releases.period for each in above))
    if (until - offset) // period > MAX_RELEASES:
        return None
    return min(_time_from(release, own.demand, above, time_base) for release in range(offset, until, period))


def _time_from(release: Time, demand: Time, above: Sequence[_CertainJobs], time_base: int) -> Time:
    """The least fixed point for a release."""
    time, before = demand, [each.before(release) for each in above]
    while True:
        # A release at the end is none before it; with a finer time base, the end can be between two picoseconds.
        end = release - (-time // time_base)
        executed = (each.demand * (each.before(end) - first) for each, first in zip(above, before, strict=True))
        reached = demand + sum(executed)
        if reached <= time:
            return time
        time = reached
