"""Senders that wait, for acknowledgements or for threads that keep the session."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.application.serving import stated_executors
from amalthea_uros.uros.middleware.profile import Profile


def check_blocking(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report waiting that execution times and response times do not contain."""
    senders = [callback for callback in callbacks if callback.outgoing]
    loops = {executor.name: executor for executor in stated_executors(profile.middleware) if executor.loop is not None}
    outside = [callback for callback in senders if not (callback.in_executor and callback.executor in loops)]
    _check_waiting_outside(outside, profile, notes)
    _check_recovery(callbacks, profile, notes)
    if loops and (outside or len(stated_executors(profile.middleware)) > 1):
        _check_threads(senders, tuple(loops.values()), profile, notes)


def _check_waiting_outside(senders: Iterable[Callback], profile: Profile, notes: Notes) -> None:
    """Report callbacks that wait for acknowledgements of a known time in tasks that are modelled without waiting."""
    how, acknowledgement = profile.sending, profile.middleware.transport.acknowledgement
    if not how.waits or acknowledgement is None:
        return
    for callback in senders:
        topics = [message.topic for message in callback.outgoing if message.reliable]
        if topics:
            longest = time_text(min(acknowledgement, how.timeout) * len(topics))
            text = f"{callback.name!r} waits up to {longest} for acknowledgements, so that its response time is unknown"
            advice = (
                "Describe the 'loop' of the executor that runs it, set 'reliable: {waits: false}' if this port does not wait, "
                "or use 'reliability: best-effort'."
            )
            notes.warning("UR124", text, callback.origin, advice)


def _check_recovery(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report incoming traffic that postpones the repetition of lost messages.

    The time without input begins anew with each message that arrives: `uxr_update_output_stream_heartbeat_timestamp` in
    src/c/core/session/stream/output_reliable_stream.c of eProsima/Micro-XRCE-DDS-Client.
    """
    how = profile.sending
    if not (profile.middleware.transport.loses_messages and how.waits) or how.resends_after is None:
        return
    incoming = [callback.incoming for callback in callbacks if callback.incoming is not None]
    dense = min(incoming, key=lambda message: message.interval, default=None)
    if dense is None or dense.interval >= how.resends_after:
        return
    for callback in callbacks:
        for message in callback.outgoing:
            if message.reliable:
                text = (
                    f"if a message of {message.topic!r} is lost, {callback.name!r} waits up to {time_text(how.timeout)}: it is sent "
                    f"again after {time_text(how.resends_after)} without input, but {dense.topic!r} can arrive every "
                    f"{time_text(dense.interval)}"
                )
                advice = "Use 'reliability: best-effort', or a shorter timeout: RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT."
                notes.warning("UR124", text, message.origin, advice)


def _check_threads(senders: Iterable[Callback], loops: Sequence[ExecutorSection], profile: Profile, notes: Notes) -> None:
    """Report threads that keep others from sending; that nothing protects the session is reported with the executors."""
    how = profile.sending
    if how.holds_session_while_waiting:
        default = profile.waiting.default_timeout
        timeout = time_text(max(_timeout(executor, default) for executor in loops))
        text = f"a thread that waits for messages keeps the session for up to {timeout}; others that send wait for it:"
        names = ", ".join(repr(callback.name) for callback in senders)
        if names:
            notes.warning(
                "UR124", f"{text} {names}", profile.middleware.location("multithread"), "Use short timeouts of the loops."
            )


def _timeout(executor: ExecutorSection, default: Time) -> Time:
    loop = executor.loop
    if loop is None:
        return 0
    times = (loop.spin_some, loop.spin, loop.timeout)
    return next((time for time in times if time is not None), default)
