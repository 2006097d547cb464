"""Messages of XRCE-DDS: their lengths, and how long they can be.

As src/c/core/session/write_access.c and src/c/core/session/stream/output_reliable_stream.c of eProsima/Micro-XRCE-DDS-Client lay them
out. A message that does not fit into a buffer of a reliable stream is cut into fragments, each of which is a message with a header.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import repeat

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.uros.middleware.figures import size
from amalthea_uros.uros.middleware.profile import MessageKind, Part
from amalthea_uros.uros.middleware.xrce_dds.limits import history, mtu

#: What some messages have before their content, beside the identifier of the entity.
_EXTRA = {
    MessageKind.REQUEST_IN: "sample_identity",
    MessageKind.RESPONSE_OUT: "sample_identity",
    MessageKind.RESPONSE_IN: "reply_header",
}
_SENT = (MessageKind.PUBLICATION, MessageKind.REQUEST_OUT, MessageKind.RESPONSE_OUT)


def parts(kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware, data: ProfileData) -> Sequence[Part]:
    """What is sent for a message; one that cannot be sent is a single part, which is longer than the MTU allows."""
    acknowledgement = size(data, "acknowledgement") if reliable else None
    headers, body = _headers(data), _body(kind, content, middleware, data)
    if not reliable or headers + body <= _capacity(True, middleware, data):
        return (Part(length=headers + body, acknowledgement=acknowledgement),)
    piece = _piece(middleware, data)
    full, rest = divmod(size(data, "submessage_header") + body, piece)
    lengths = [*repeat(piece, full), *([rest] if rest else [])]
    return tuple(Part(length=headers + length, acknowledgement=acknowledgement) for length in lengths)


def largest_content(kind: MessageKind, *, reliable: bool, waits: bool, middleware: Middleware, data: ProfileData) -> int:
    """The longest content of a message; 0 if not even an empty one can be sent."""
    whole = _capacity(reliable, middleware, data) - _headers(data)
    if not reliable:
        return _content(kind, whole, middleware, data)
    return _content(kind, max(whole, _longest_fragmented(kind, waits, middleware, data)), middleware, data)


def _longest_fragmented(kind: MessageKind, waits: bool, middleware: Middleware, data: ProfileData) -> int:
    """The longest body in fragments: as many as there are buffers, or any number if full buffers can be emptied in between.

    That is not possible in builds for several threads: see `uxr_prepare_output_stream_fragmented`.
    """
    if kind in _SENT and waits and not middleware.multithread:
        return size(data, "longest_payload")
    buffers = history(middleware, data, "OUTPUT" if kind in _SENT else "INPUT")
    return _piece(middleware, data) * buffers - size(data, "submessage_header")


def _headers(data: ProfileData) -> int:
    return size(data, "message_header") + size(data, "submessage_header")


def _capacity(reliable: bool, middleware: Middleware, data: ProfileData) -> int:
    """The longest message that is not cut into fragments."""
    return mtu(middleware, data) - (size(data, "buffer_header") if reliable else 0)


def _piece(middleware: Middleware, data: ProfileData) -> int:
    """What a fragment carries, at least one byte."""
    return max(1, _capacity(True, middleware, data) - _headers(data))


def _body(kind: MessageKind, content: int, middleware: Middleware, data: ProfileData) -> int:
    """The payload of the submessage, aligned."""
    alignment = _alignment(kind, middleware, data)
    return -(-(_fixed(kind, middleware, data) + content) // alignment) * alignment


def _content(kind: MessageKind, body: int, middleware: Middleware, data: ProfileData) -> int:
    """The longest content in a payload."""
    alignment = _alignment(kind, middleware, data)
    return max(0, body // alignment * alignment - _fixed(kind, middleware, data))


def _fixed(kind: MessageKind, middleware: Middleware, data: ProfileData) -> int:
    """The part of the payload that is not content; all headers together are what the description states as `overhead`."""
    transport = middleware.transport
    if transport.states("overhead"):
        return -(-transport.overhead // 8) - _headers(data)
    return size(data, "object") + (size(data, _EXTRA[kind]) if kind in _EXTRA else 0)


def _alignment(kind: MessageKind, middleware: Middleware, data: ProfileData) -> int:
    aligned = kind in _SENT and not middleware.transport.states("overhead")
    return max(1, size(data, "alignment")) if aligned else 1
