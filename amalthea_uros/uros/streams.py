"""Reliable streams of XRCE-DDS: a message stays in the buffers of the output stream until the agent acknowledges it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import Time, data_size_text, time_text
from amalthea_uros.uros.callbacks import Callback, Message
from amalthea_uros.uros.notes import Notes

#: Default number of buffers of a stream, from the table in the README of micro-ROS/rmw_microxrcedds.
DEFAULT_STREAM_HISTORY = 4


def check_streams(callbacks: Iterable[Callback], middleware: Middleware, notes: Notes) -> None:
    """Report reliable messages if the acknowledgement time is unknown, or if they need more buffers than the stream has."""
    sent = [message for callback in callbacks for message in callback.outgoing if message.reliable]
    acknowledgement = middleware.transport.acknowledgement
    if acknowledgement is not None:
        _check_history(sent, acknowledgement, middleware, notes)
        return
    for message in sent:
        text = f"{message.topic!r} is sent reliably, but the acknowledgement time is not specified"
        advice = "Set 'acknowledgement' under 'transport', or use 'reliability: best-effort'."
        notes.warning("UR122", text, message.origin, advice)


def _check_history(sent: Iterable[Message], acknowledgement: Time, middleware: Middleware, notes: Notes) -> None:
    limits = middleware.limits
    history = limits.RMW_UXRCE_STREAM_HISTORY or DEFAULT_STREAM_HISTORY
    buffers = sum(_buffers(message, middleware) * -(-acknowledgement // message.interval) for message in sent)
    if buffers > history:
        text = f"up to {buffers} buffers wait for acknowledgement at the same time, but the reliable stream has only {history}"
        advice = f"Set RMW_UXRCE_STREAM_HISTORY to {buffers} or more, or send less data per {time_text(acknowledgement)}."
        notes.warning("UR123", text, middleware.transport.location("acknowledgement"), advice)


def _buffers(message: Message, middleware: Middleware) -> int:
    """The number of buffers that a message occupies; one if the MTU is unknown."""
    mtu = middleware.limits.RMW_UXRCE_MTU
    return 1 if mtu is None else -(-(message.size + middleware.transport.overhead) // mtu)


def check_message_sizes(callbacks: Iterable[Callback], middleware: Middleware, notes: Notes) -> None:
    """Report messages that do not fit into their buffers."""
    for sent in _messages(callbacks):
        _check_size(sent, middleware, notes)


def _messages(callbacks: Iterable[Callback]) -> Iterator[Message]:
    """Each message once, even if several callbacks send it."""
    seen = set()
    for callback in callbacks:
        for message in (callback.incoming, *callback.outgoing):
            if message is not None and (key := (message.topic, message.size, message.origin)) not in seen:
                seen.add(key)
                yield message


def _check_size(message: Message, middleware: Middleware, notes: Notes) -> None:
    """Report a best-effort message larger than the MTU, or a reliable one larger than all buffers of its stream."""
    limits = middleware.limits
    if limits.RMW_UXRCE_MTU is None:
        return
    history = limits.RMW_UXRCE_STREAM_HISTORY or DEFAULT_STREAM_HISTORY
    capacity = limits.RMW_UXRCE_MTU * (history if message.reliable else 1)
    size = message.size + middleware.transport.overhead
    if size > capacity:
        source, options = "RMW_UXRCE_MTU", "RMW_UXRCE_MTU"
        if message.reliable:
            source = f"RMW_UXRCE_MTU times RMW_UXRCE_STREAM_HISTORY ({history})"
            options = "RMW_UXRCE_MTU or RMW_UXRCE_STREAM_HISTORY"
        needed, limit = data_size_text(size), data_size_text(capacity)
        text = f"a message of {message.topic!r} needs {needed} with headers, but the limit is {limit}: {source}"
        notes.error("UR121", text, message.origin, f"Increase {options}, or reduce the size of the message.")
