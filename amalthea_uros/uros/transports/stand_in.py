"""XRCE-DDS messages."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.middleware.profile import MessageKind, MiddlewareThread, Part

_ACKNACK = 13


class XrceMessages:
    """Lengths of messages."""

    def parts(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Sequence[Part]:
        """One message, or fragments."""
        mtu = 63 if middleware.transport.can_fd else 512
        identity = {MessageKind.REQUEST_IN: 24, MessageKind.RESPONSE_OUT: 24, MessageKind.RESPONSE_IN: 4}.get(kind, 0)
        length = 12 + -(-(content + identity) // 4) * 4
        answer = _ACKNACK if reliable else None
        if length <= mtu or not reliable:
            return (Part(length=length, acknowledgement=answer),)
        pieces = -(-length // (mtu - 12))
        return tuple(Part(length=mtu, acknowledgement=answer) for _ in range(pieces))

    def heartbeat(self, middleware: Middleware) -> tuple[int, Time] | None:
        """A message in 100 ms."""
        return _ACKNACK, 100 * MILLISECOND

    def threads(self, middleware: Middleware) -> Sequence[MiddlewareThread]:
        """None."""
        return ()
