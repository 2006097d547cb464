"""Messages of zenoh-pico: their lengths, and how long they can be.

As src/protocol/codec of eclipse-zenoh/zenoh-pico lays them out, with what rmw_zenoh attaches to each message. Variable lengths are the
longest ones. A message that does not fit into a batch is cut into fragments; the receiver joins them up to `FRAG_MAX_SIZE`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import repeat

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.uros.middleware.figures import size, stated_length
from amalthea_uros.uros.middleware.profile import MessageKind, Part

_MESSAGES = ("push_header", "key", "put_header", "attachment", "encapsulation")
_FRAME = ("frame_header", "sequence_number")
#: Each byte of a length carries 7 bits of it.
_BITS_OF_LENGTH = 7


def parts(kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware, data: ProfileData) -> Sequence[Part]:
    """What is sent for a message, without the length that precedes it on TCP."""
    frame = sum(size(data, name) for name in _FRAME)
    message = _overhead(kind, reliable, data) + _length_of_length(content, data) + content
    piece = max(1, batch(middleware, data) - frame)
    full, rest = divmod(message, piece)
    return tuple(Part(length=frame + length) for length in (*repeat(piece, full), *([rest] if rest else [])))


def largest_content(kind: MessageKind, *, reliable: bool, middleware: Middleware, data: ProfileData) -> int:
    """The longest content of a message."""
    limit = _limit("FRAG_MAX_SIZE", middleware, data)
    longest = max(0, limit - _overhead(kind, reliable, data))
    return max(0, longest - _length_of_length(longest, data))


def batch(middleware: Middleware, data: ProfileData) -> int:
    """The longest batch on a connection in bytes."""
    return _limit("BATCH_UNICAST_SIZE", middleware, data)


def _limit(name: str, middleware: Middleware, data: ProfileData) -> int:
    length = stated_length(middleware.limits, name, f"Z_{name}")
    return data.options[name] if length is None else length


def _overhead(kind: MessageKind, reliable: bool, data: ProfileData) -> int:
    """Everything but the content, its length, and the frame."""
    names = list(_MESSAGES)
    if reliable:
        names.append("quality_of_service")
    if kind not in (MessageKind.PUBLICATION, MessageKind.DELIVERY):
        names.append("query")
    return sum(size(data, name) for name in names)


def _length_of_length(content: int, data: ProfileData) -> int:
    """Bytes in which the length of a payload is written, with the header of its serialisation."""
    bits = (content + size(data, "encapsulation")).bit_length()
    return max(1, -(-bits // _BITS_OF_LENGTH))
