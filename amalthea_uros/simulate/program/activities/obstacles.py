"""What is refused."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.perf.activities import SenderReceiverAccess, ServerCall
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.timing.jobs.server_calls import obstacle

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body


def check_executing(body: Body, activity: ServerCall | SenderReceiverAccess) -> None:
    """Refuse runnables that are to be executed, but that no process executes.

    Raises
    ------
    NotSimulatedError : there is one.
    """
    reason = obstacle(activity, body.resources.executing)
    if reason:
        raise NotSimulatedError(reason)
