"""The longest busy period of the processes of a level: within it, each of their jobs ends, in whatever order they are served.

A busy period is an interval in which a job of the level is always pending; the longest one is the least fixed point of what is
activated in it (J. P. Lehoczky, "Fixed priority scheduling of periodic task sets with arbitrary deadlines", RTSS 1990). Of jobs that
exclude each other, because a process triggers only some of them, it serves one that takes as long as the longest path: it is bounded
even where the sum of all paths overloads the core.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.response_times.busy_window import Interference, demand_rate
from amalthea_uros.analyze.response_times.task import AnalysedTask, Supply
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "longest busy period, of jobs that exclude each other the longest"
SOURCE = "Lehoczky 1990"


def response_time(
    task: AnalysedTask, level: Sequence[AnalysedTask], blocking: Time, supply: Supply, other: Response
) -> Response:
    """A bound of the response time of a task; if there is none, the result of another method.

    Parameters
    ----------
    level : what is served before the end of the busy period, including the task, alone or with others
    blocking : by tasks below the level
    """
    if sum(map(demand_rate, level)) > supply.rate:
        return other
    window = Interference.of(level, supply).window(blocking, 1)
    if window is None:
        return other
    own = task.demand.worst
    return Response(
        worst=window,
        best=other.best,
        method=METHOD,
        source=SOURCE,
        claim=Claim.BOUND,
        window=window,
        terms={"own": own, "interference": window - own - blocking, "blocking": blocking},
    )
