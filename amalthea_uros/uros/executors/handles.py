"""The handles of an executor: one for each callback, several for the services of parameters and of the lifecycle.

Default depths are those of the quality of service profiles in ros2/rmw `rmw/include/rmw/qos_profiles.h`: 10 by default, 5 for sensor
data, which is the usual profile of best effort.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from amalthea_uros.perf.executors import Handle, HandleKind, Publication
from amalthea_uros.perf.software import Runnable
from amalthea_uros.spec.application import MessageCallback, Subscription
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import SECOND
from amalthea_uros.uros.callbacks import Callback, CallbackKind, transmission_name_of
from amalthea_uros.uros.executors.counts import handle_count, source_count
from amalthea_uros.uros.executors.profile import publications_of
from amalthea_uros.uros.executors.wires import describes_wire

_DEPTH_RELIABLE, _DEPTH_BEST_EFFORT = 10, 5
_KINDS = {
    CallbackKind.SUBSCRIPTION: HandleKind.SUBSCRIPTION,
    CallbackKind.TIMER: HandleKind.TIMER,
    CallbackKind.SERVICE: HandleKind.SERVICE,
    CallbackKind.CLIENT: HandleKind.CLIENT,
    CallbackKind.GUARD_CONDITION: HandleKind.GUARD_CONDITION,
    CallbackKind.ACTION_SERVER: HandleKind.ACTION_SERVER,
    CallbackKind.ACTION_CLIENT: HandleKind.ACTION_CLIENT,
    CallbackKind.PARAMETERS: HandleKind.PARAMETER_SERVICE,
    CallbackKind.LIFECYCLE: HandleKind.LIFECYCLE_SERVICE,
}


def handle_names(callback: Callback) -> tuple[str, ...]:
    """The names of the handles of a callback."""
    if callback.kind in (CallbackKind.PARAMETERS, CallbackKind.LIFECYCLE):
        return tuple(f"{callback.name}_{number}" for number in range(1, handle_count(callback) + 1))
    return (callback.name,)


def handles_of(callback: Callback, take: Runnable | None, body: Runnable, middleware: Middleware) -> Iterator[Handle]:
    """The handles of a callback in its executor.

    Parameters
    ----------
    take : what takes its message; None if that costs nothing
    body : what the executor calls
    """
    section = callback.section
    is_subscription = isinstance(section, Subscription)
    has_messages = callback.kind not in (CallbackKind.TIMER, CallbackKind.GUARD_CONDITION)
    reliable = has_messages and (not isinstance(section, Subscription) or section.reliability == "reliable")
    incoming = callback.incoming
    handle = Handle(
        name=callback.name,
        kind=_KINDS[callback.kind],
        runnable=body.name,
        take=take.name if take else None,
        interval=callback.interval,
        jitter=callback.jitter,
        is_periodic=is_subscription or callback.kind is CallbackKind.TIMER,
        phase=section.phase,
        transmission=(
            transmission_name_of(incoming, incoming=True) if incoming and describes_wire(middleware.transport) else None
        ),
        always=isinstance(section, Subscription) and section.invocation == "always",
        depth=_depth(section, reliable) if isinstance(section, MessageCallback) else None,
        overwrites=not isinstance(section, MessageCallback) or section.history == "keep-last",
        reliable=reliable,
        sources=source_count(callback),
        publications=tuple(_publications(callback, middleware)) if callback.in_executor else (),
        origin=callback.origin,
    )
    for name in handle_names(callback):
        yield replace(handle, name=name)


def _depth(section: MessageCallback, reliable: bool) -> int:
    return section.depth or (_DEPTH_RELIABLE if reliable else _DEPTH_BEST_EFFORT)


def _publications(callback: Callback, middleware: Middleware) -> Sequence[Publication]:
    if callback.kind not in (CallbackKind.PARAMETERS, CallbackKind.LIFECYCLE):
        return publications_of(callback, middleware)
    # Its sizes are not described, but responses are reliable, and keep the executor as others do.
    waits = middleware.reliable.waits
    timeout = (middleware.reliable.timeout or SECOND) if waits else None
    answer = Publication(topic=f"{callback.name} (response)", reliable=True, waits=waits, timeout=timeout)
    server = callback.node.parameter_server if callback.kind is CallbackKind.PARAMETERS else None
    changes = Publication(topic="parameter_events", reliable=True, waits=waits, timeout=timeout)
    return (answer, changes) if server is not None and server.events else (answer,)
