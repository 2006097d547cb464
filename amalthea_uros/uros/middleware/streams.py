"""Reliable messages: until they are acknowledged, they keep buffers, and with most middlewares also the callback that sends them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.callbacks import Callback, Message
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.kinds import content_bytes, message_kind
from amalthea_uros.uros.middleware.profile import Profile


def check_streams(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report reliable messages whose acknowledgement time is not known, or that need more buffers than there are."""
    buffers = profile.buffers
    if buffers is None:
        return
    sent = [message for callback in callbacks for message in callback.outgoing if message.reliable]
    acknowledgement = profile.middleware.transport.acknowledgement
    if acknowledgement is None and profile.middleware.agent.acknowledgement is None:
        _report_unknown_time(sent, profile, notes)
    if profile.sending.waits:
        _check_steps(sent, buffers, profile, notes)
    elif acknowledgement is not None:
        _check_buffers(sent, buffers, acknowledgement, profile, notes)


def _report_unknown_time(sent: Iterable[Message], profile: Profile, notes: Notes) -> None:
    how = profile.sending
    for message in sent:
        blocks = f": it blocks {message.callback!r} for up to {time_text(how.timeout)}" if how.waits else ""
        text = f"{message.topic!r} is sent reliably, but the acknowledgement time is not specified{blocks}"
        ways = ["Set 'acknowledgement' under 'transport'", "use 'reliability: best-effort'"]
        if how.waits:
            ways.append("set 'reliable: {waits: false}' if this port does not wait")
        notes.warning("UR122", text, message.origin, f"{', or '.join(ways)}.")


def _check_steps(sent: Iterable[Message], buffers: int, profile: Profile, notes: Notes) -> None:
    """Report messages of more fragments than there are buffers: only one message waits for its acknowledgement at a time."""
    for message in sent:
        fragments = _fragments(message, profile)
        if fragments > buffers:
            steps = -(-fragments // buffers)
            text = (
                f"a message of {message.topic!r} has {fragments} fragments, but the reliable stream has only {buffers} buffers"
            )
            blocks = f"it is sent in {steps} steps, and {message.callback!r} waits for the acknowledgement of each"
            advice = f"Set RMW_UXRCE_STREAM_HISTORY to {_power_of_two(fragments)}, or send less data."
            notes.warning("UR123", f"{text}: {blocks}", message.origin, advice)


def _check_buffers(sent: Iterable[Message], history: int, acknowledgement: Time, profile: Profile, notes: Notes) -> None:
    """Report if the messages within an acknowledgement time need more buffers than there are."""
    buffers = sum(_fragments(message, profile) * -(-acknowledgement // message.interval) for message in sent)
    if buffers > history:
        text = f"up to {buffers} buffers wait for acknowledgement at the same time, but the reliable stream has only {history}"
        size, time = _power_of_two(buffers), time_text(acknowledgement)
        advice = f"Set RMW_UXRCE_STREAM_HISTORY to {size} or more, or send less data per {time}."
        notes.warning("UR123", text, profile.middleware.transport.location("acknowledgement"), advice)


def _fragments(message: Message, profile: Profile) -> int:
    kind = message_kind(message, incoming=False)
    return len(profile.parts(kind, content_bytes(message), reliable=True))


def _power_of_two(number: int) -> int:
    """The least power of two that is not less; the build accepts no other history."""
    return 1 << (number - 1).bit_length()
