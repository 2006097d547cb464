"""What takes time on the core."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.perf.activities import Execute, ExecutionNeed, Incomplete
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.timing.basics.settings import Memory

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body


def execute(body: Body, activity: Execute) -> None:
    """Ticks or time."""
    body.demand(activity.demand)


def execution_need(body: Body, activity: ExecutionNeed) -> None:
    """Needs, one after the other."""
    for name, need in activity.needs:
        factor = body.context.demand_model.ticks_per_unit(name, body.core)
        body.execute(body.resources.ticks(need, body.core, factor, f"{body.place()} {name}"))


def incomplete(body: Body, activity: Incomplete) -> None:
    """Refuse what the model does not state, unless it is an access that takes no time."""
    if not activity.is_access or body.context.settings.memory is not Memory.NONE:
        raise NotSimulatedError(f"it contains {activity.reason}")
