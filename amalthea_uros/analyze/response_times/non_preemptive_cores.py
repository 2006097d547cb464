"""Response times of tasks that any core of their scheduler executes, by fixed priorities, each job to its end.

M. Nasri, G. Nelissen and B. B. Brandenburg, "A response-time analysis for non-preemptive job sets under global scheduling", ECRTS 2018:
all schedules are explored as a graph of states (theorem 1: no job ends earlier or later than the states say), until they repeat.

There, two jobs of a task are as independent as any others, so that they could execute at the same time. So the times hold if each job
ends before the next one of its task is activated; then no job ever waits for another one of its task.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros.analyze.response_times.schedule_abstraction import JobEnds, JobStream, explored
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import percent_text

METHOD = "all schedules until they repeat, several cores, fixed priorities, non-preemptive"
SOURCE = "Nasri, Nelissen, Brandenburg 2018"


def response_times(streams: Sequence[JobStream], cores: int) -> Iterator[Response]:
    """The response times of tasks, the most important one first; none has one if a job may not end before the next activation."""
    load = sum(Fraction(sum(worst for _, worst in each.demands[each.lead :]), each.cycle * each.period) for each in streams)
    completions = explored(streams, cores) if load <= cores else None
    if completions is None:
        reason = f"the schedules of its tasks on {cores} cores are too many to explore all of them"
        if load > cores:
            reason = f"the jobs of its tasks need up to {percent_text(load / cores, 1)} % of its {cores} cores"
    elif any(ends.latest > stream.period for ends, stream in zip(completions, streams, strict=True)):
        reason = f"a task on its {cores} cores need not end before its next activation, and is never preempted"
    else:
        yield from (_response(stream, ends) for stream, ends in zip(streams, completions, strict=True))
        return
    for stream in streams:
        shortest = min(best for best, _ in stream.demands)
        yield Response(worst=None, best=shortest, method=METHOD, source=SOURCE, claim=Claim.BOUND, reason=reason)


def _response(stream: JobStream, ends: JobEnds) -> Response:
    own = stream.demand(ends.job)[1]
    return Response(
        worst=ends.latest,
        best=ends.earliest,
        method=METHOD,
        source=SOURCE,
        claim=Claim.BOUND,
        jobs=ends.jobs,
        window=ends.latest,
        terms={"own": own, "interference": ends.latest - own},
    )
