"""How messages of XRCE-DDS are sent: a reliable one keeps its sender until the agent has acknowledged all of it.

As in rmw_publish.c, rmw_request.c and rmw_response.c of micro-ROS/rmw_microxrcedds: `uxr_run_session_until_confirm_delivery` follows
each message, so that there is never more than one message that is not acknowledged.
"""

from __future__ import annotations

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import Time
from amalthea_uros.uros.middleware.profile import MessageKind, Sending
from amalthea_uros.uros.middleware.xrce_dds.limits import heartbeat_interval, history, publish_timeout
from amalthea_uros.uros.middleware.xrce_dds.messages import parts


def sending(middleware: Middleware, data: ProfileData) -> Sending:
    """How messages are sent."""
    return Sending(
        waits=data.sending.waits and middleware.reliable.waits,
        timeout=publish_timeout(middleware, data),
        resends_after=heartbeat_interval(middleware, data),
        holds_session_while_waiting=data.sending.holds_session_while_waiting and middleware.multithread,
        drops_when_busy=data.sending.drops_when_busy,
        is_protected=data.sending.is_protected or middleware.multithread,
    )


def gives_up_after(
    kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware, data: ProfileData
) -> Time | None:
    """Time after which the sender of a message stops waiting; None if it does not wait.

    A message of more fragments than there are buffers is sent in several steps, each of which waits until the buffers are empty.
    """
    how = sending(middleware, data)
    if not (reliable and how.waits):
        return None
    fragments = len(parts(kind, content, reliable=True, middleware=middleware, data=data))
    flushes = -(-fragments // history(middleware, data, "OUTPUT")) - 1
    return how.timeout + flushes * (data.sending.flush_timeout or how.timeout)
