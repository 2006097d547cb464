"""Frames that others send on a CAN bus."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from amalthea_uros.diagnostics import Location
from amalthea_uros.spec.transports import Can, CanFd
from amalthea_uros.units import Time

#: The greatest identifier of 11 bits.
_GREATEST_STANDARD = 0x7FF
#: After the bits that both formats share, a standard frame wins against an extended one.
_EXTENSION_BITS = 18


@dataclass(frozen=True, slots=True, kw_only=True)
class ForeignFrame:
    """A foreign frame: one that neither the controller nor the agent sends.

    Attributes
    ----------
    period : minimum time between two of them; None if it is not known
    jitter : maximum delay against its nominal time
    """

    name: str
    identifier: int
    extended: bool
    data_bytes: int
    period: Time | None
    jitter: Time = 0
    origin: Location | None = None

    @property
    def rank(self) -> int:
        """Its place in the arbitration; the lowest one wins."""
        return arbitration_rank(self.identifier, extended=self.extended)


def arbitration_rank(identifier: int, *, extended: bool) -> int:
    """The place of an identifier in the arbitration; the lowest one wins.

    The first 11 bits are compared first; then the bit that marks an extended identifier loses (ISO 11898-1).
    """
    if not extended:
        return identifier << _EXTENSION_BITS + 1
    base, extension = divmod(identifier, 1 << _EXTENSION_BITS)
    return (base << _EXTENSION_BITS + 1) + (1 << _EXTENSION_BITS) + extension


def described_frames(bus: Can | CanFd) -> Iterator[ForeignFrame]:
    """The frames of others in a description."""
    for frame in bus.foreign:
        yield ForeignFrame(
            name=frame.name,
            identifier=frame.identifier,
            extended=bus.identifier == "extended" or frame.identifier > _GREATEST_STANDARD,
            data_bytes=frame.bytes,
            period=frame.period,
            jitter=frame.jitter or 0,
            origin=frame.location(),
        )


def without_own(frames: Sequence[ForeignFrame], bus: Can | CanFd) -> tuple[ForeignFrame, ...]:
    """The frames whose identifiers are not those of the messages of the application itself."""
    own = {*bus.identifiers.values()}
    return tuple(frame for frame in frames if frame.identifier not in own)
