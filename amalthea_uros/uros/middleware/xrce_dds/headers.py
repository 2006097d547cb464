"""What XRCE-DDS puts before the content of a message.

As src/c/core/session/session_info_internal.h, submessage_internal.h and write_access.c of eProsima/Micro-XRCE-DDS-Client lay it out.
"""

from __future__ import annotations

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.uros.middleware.figures import size
from amalthea_uros.uros.middleware.profile import MessageKind

#: What some messages have before their content, beside the identifier of the entity.
_EXTRA = {
    MessageKind.REQUEST_IN: "sample_identity",
    MessageKind.RESPONSE_OUT: "sample_identity",
    MessageKind.RESPONSE_IN: "reply_header",
}
#: What the controller sends.
SENT = (MessageKind.PUBLICATION, MessageKind.REQUEST_OUT, MessageKind.RESPONSE_OUT)


def headers(data: ProfileData) -> int:
    """The headers of a message and its submessage."""
    return size(data, "message_header") + size(data, "submessage_header")


def capacity(reliable: bool, mtu: int, data: ProfileData) -> int:
    """The longest message that is not cut into fragments."""
    return mtu - (size(data, "buffer_header") if reliable else 0)


def piece(mtu: int, data: ProfileData) -> int:
    """What a fragment carries; not positive if the MTU has no room for one."""
    return capacity(True, mtu, data) - headers(data)


def payload(kind: MessageKind, content: int, middleware: Middleware, data: ProfileData) -> int:
    """The payload of the submessage, aligned."""
    alignment = _alignment(kind, middleware, data)
    return -(-(_fixed(kind, middleware, data) + content) // alignment) * alignment


def content_of(kind: MessageKind, payload: int, middleware: Middleware, data: ProfileData) -> int:
    """The longest content in a payload."""
    alignment = _alignment(kind, middleware, data)
    return max(0, payload // alignment * alignment - _fixed(kind, middleware, data))


def _fixed(kind: MessageKind, middleware: Middleware, data: ProfileData) -> int:
    """The part of the payload that is not content; all headers together are what the description states as `overhead`."""
    transport = middleware.transport
    if transport.states("overhead"):
        return -(-transport.overhead // 8) - headers(data)
    return size(data, "object") + (size(data, _EXTRA[kind]) if kind in _EXTRA else 0)


def _alignment(kind: MessageKind, middleware: Middleware, data: ProfileData) -> int:
    aligned = kind in SENT and not middleware.transport.states("overhead")
    return max(1, size(data, "alignment")) if aligned else 1
