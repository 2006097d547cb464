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
from amalthea_uros.uros.middleware.xrce_dds.headers import SENT, capacity, content_of, headers, payload, piece
from amalthea_uros.uros.middleware.xrce_dds.limits import input_history, mtu, output_history


def parts(kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware, data: ProfileData) -> Sequence[Part]:
    """What is sent for a message; one that cannot be sent is a single part, which is longer than the MTU allows."""
    acknowledgement = size(data, "acknowledgement") if reliable else None
    before, body, limit = headers(data), payload(kind, content, middleware, data), mtu(middleware, data)
    is_whole = before + body <= capacity(True, limit, data)
    if not reliable or is_whole or body > size(data, "longest_payload"):
        return (Part(length=before + body, acknowledgement=acknowledgement),)
    most = max(1, piece(limit, data))
    full, rest = divmod(size(data, "submessage_header") + body, most)
    lengths = [*repeat(most, full), *([rest] if rest else [])]
    return tuple(Part(length=before + length, acknowledgement=acknowledgement) for length in lengths)


def largest_content(kind: MessageKind, *, reliable: bool, waits: bool, middleware: Middleware, data: ProfileData) -> int:
    """The longest content of a message; 0 if not even an empty one can be sent."""
    whole = capacity(reliable, mtu(middleware, data), data) - headers(data)
    if not reliable:
        return content_of(kind, whole, middleware, data)
    return content_of(kind, max(whole, _longest_fragmented(kind, waits, middleware, data)), middleware, data)


def _longest_fragmented(kind: MessageKind, waits: bool, middleware: Middleware, data: ProfileData) -> int:
    """The longest payload in fragments: as many as there are buffers, or any number if full buffers can be emptied in between.

    That is not possible in builds for several threads: see `uxr_prepare_output_stream_fragmented`.
    """
    if kind in SENT and waits and not middleware.multithread:
        return size(data, "longest_payload")
    history = output_history if kind in SENT else input_history
    return max(1, piece(mtu(middleware, data), data)) * history(middleware, data) - size(data, "submessage_header")
