"""The calls of the other callbacks at the polling points while one is pending (T. Blass et al., RTSS 2021; see `starvation_free`)."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.analyze.host.starvation_free import ReadySet
from amalthea_uros.units import Time

METHOD = "polling points while a callback is pending"


def latest(index: int, ready: ReadySet, known: Mapping[str, Time]) -> Time:
    """The response time of a callback if those of all are known."""
    task, limit = ready.tasks[index], known[ready.tasks[index].name]

    def before(start: Time) -> Time:
        demand = 1 + task.demand.max_demand(task.events.eta_plus(start + limit - 1) - 1)
        for number, other in enumerate(ready.tasks):
            if other is not task:
                released = other.events.eta_plus(start + known[other.name] - 1)
                demand += other.demand.max_demand(min(released, ready.most_calls(number, index, known)))
        return demand

    start = 1
    # More than the known bound cannot improve it.
    while start <= limit:
        reached = ready.supply.time_for(before(start))
        if reached <= start:
            # The job starts with the last tick of this demand, and takes the rest of its own.
            return ready.supply.time_for(before(start) + task.demand.worst - 1)
        start = reached
    return limit
