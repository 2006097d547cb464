"""The handles of an executor: one for each callback, several for the services of parameters and of the lifecycle."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from amalthea_uros.perf.executors import Handle, HandleKind
from amalthea_uros.perf.software import Runnable
from amalthea_uros.spec.application import MessageCallback, Subscription
from amalthea_uros.uros.callbacks import Callback, CallbackKind, transmission_name_of
from amalthea_uros.uros.executors.counts import handle_count, source_count
from amalthea_uros.uros.middleware.histories import depth_of
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.publications import publications
from amalthea_uros.uros.transports.line import describes_wire

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


def handles_of(callback: Callback, take: Runnable | None, body: Runnable, profile: Profile) -> Iterator[Handle]:
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
            transmission_name_of(incoming, incoming=True) if incoming and describes_wire(profile.middleware.transport) else None
        ),
        always=isinstance(section, Subscription) and section.invocation == "always",
        depth=depth_of(section),
        overwrites=not isinstance(section, MessageCallback) or section.history == "keep-last",
        reliable=reliable,
        sources=source_count(callback),
        publications=publications(callback, profile) if callback.in_executor else (),
        origin=callback.origin,
    )
    for name in handle_names(callback):
        yield replace(handle, name=name)
