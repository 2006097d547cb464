"""What the messages of callbacks are for the middleware."""

from __future__ import annotations

from amalthea_uros.uros.application.callbacks import Message
from amalthea_uros.uros.middleware.profile import MessageKind

#: Bytes of a message, above which it is refused whatever the middleware: its parts and frames could take all memory.
LONGEST = 2**20
#: By the ends of the names of their channels; for messages that arrive and for those that leave.
_KINDS = {
    "_topic": (MessageKind.DELIVERY, MessageKind.PUBLICATION),
    "_request": (MessageKind.REQUEST_IN, MessageKind.REQUEST_OUT),
    "_response": (MessageKind.RESPONSE_IN, MessageKind.RESPONSE_OUT),
}


def message_kind(message: Message, *, incoming: bool) -> MessageKind:
    """What a message is for the middleware."""
    kinds = next(kinds for end, kinds in _KINDS.items() if message.channel.endswith(end))
    return kinds[0] if incoming else kinds[1]


def content_bytes(message: Message) -> int:
    """The length of a message in bytes, without headers; of one that is too long for everything, the longest that is not."""
    return min(stated_bytes(message), LONGEST)


def stated_bytes(message: Message) -> int:
    """The length of a message in bytes, without headers, however long it is."""
    return -(-message.size // 8)
