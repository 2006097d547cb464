"""Response times in an executor of one thread that calls each ready callback once before it polls again.

After T. Blass, D. Casini, S. Bozhko and B. B. Brandenburg, "A ROS 2 response-time analysis exploiting starvation freedom and
execution-time variance", RTSS 2021. While a job is pending for n polling points, any other callback is called n times at most, and
once more if it comes before the job in a ready set. Bounds of the response times of all callbacks have to be known before; each
result can only be smaller, so that results may be used in their turn.

It holds for executors that work off a whole ready set: the single-threaded one, and the static one up to iron. The order in a ready
set is not known from jazzy on, nor across callback groups from galactic on (`owner_less` maps and hash tables of addresses in
rclcpp): then every callback counts as one that comes before.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "polling points while a callback is pending"
SOURCE = "Blass, Casini, Bozhko, Brandenburg 2021"


def improved(
    tasks: Sequence[AnalysedTask], known: Mapping[str, Response], is_ordered: bool, supply: Supply = FULL
) -> Mapping[str, Response]:
    """The response times of all callbacks of an executor, each the smaller one of a known bound and this one.

    Parameters
    ----------
    tasks : the callbacks, in the order of the ready set if that is known
    known : bounds by name; all of them must be finite
    """
    best = {name: response.worst or 0 for name, response in known.items()}
    for _ in range(MAX_STEPS):
        reached = {
            task.name: min(best[task.name], _response(index, tasks, best, is_ordered, supply))
            for index, task in enumerate(tasks)
        }
        if reached == best:
            break
        best = reached
    return {name: _response_of(response, best[name]) for name, response in known.items()}


def _response_of(known: Response, worst: Time) -> Response:
    if worst == known.worst:
        return known
    return Response(worst=worst, best=known.best, method=METHOD, source=SOURCE, claim=Claim.BOUND)


def _response(index: int, tasks: Sequence[AnalysedTask], known: Mapping[str, Time], is_ordered: bool, supply: Supply) -> Time:
    task = tasks[index]
    points, limit = task.events.eta_plus(known[task.name]), known[task.name]

    def before(start: Time) -> Time:
        demand = 1 + task.demand.max_demand(task.events.eta_plus(start + known[task.name] - 1) - 1)
        for number, other in enumerate(tasks):
            if other is not task:
                released = other.events.eta_plus(start + known[other.name] - 1)
                called = points + (1 if number < index or not is_ordered else 0)
                demand += other.demand.max_demand(min(released, called))
        return demand

    start = 1
    # More than the known bound cannot improve it.
    while start <= limit:
        reached = supply.time_for(before(start))
        if reached <= start:
            # The job starts with the last tick of this demand, and takes the rest of its own.
            return supply.time_for(before(start) + task.demand.worst - 1)
        start = reached
    return limit
