"""Markers: the frames of a CAN bus that say that something starts, ends, or how long it took."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.trace.can.frames import EXTENDED
from amalthea_uros.units import Time

#: What a value in a payload is; None: the payload is too short for it, or says that there is none.
Decoder: TypeAlias = Callable[[bytes], Fraction | None]

#: Largest standard and extended identifiers.
_STANDARD, _LARGEST = 0x7FF, 0x1FFFFFFF
_FORM = re.compile(r"(?:(?P<channel>[^:#\s]+):)?(?:0[xX])?(?P<id>[0-9a-fA-F]{1,8})(?:#(?P<data>(?:[0-9a-fA-F]{2}|[xX]{2})+))?")
#: How markers are written, and an example for messages.
FORM = "[CHANNEL:]ID[#DATA]"
_EXAMPLE = "an example: 0x18000001, 123#01, or can0:123#xx02 (xx is any byte)"


@dataclass(frozen=True, slots=True)
class Marker:
    """Frames with an identifier, and with a payload that begins with some bytes.

    Attributes
    ----------
    identifier : with the bit `EXTENDED` if it has 29 bits
    data : the first bytes; None is any byte
    channel : the name of the bus; None: any
    """

    identifier: int
    data: tuple[int | None, ...] = ()
    channel: str | None = None

    def fits(self, payload: bytes) -> bool:
        """Whether a payload begins with the bytes."""
        return len(payload) >= len(self.data) and all(
            wanted is None or wanted == byte for wanted, byte in zip(self.data, payload, strict=False)
        )

    def overlaps(self, other: Marker) -> bool:
        """Whether a frame can be both."""
        is_one_bus = self.channel is None or other.channel is None or self.channel == other.channel
        bytes_ = zip(self.data, other.data, strict=False)
        is_one_payload = all(one is None or two is None or one == two for one, two in bytes_)
        return self.identifier == other.identifier and is_one_bus and is_one_payload

    def __str__(self) -> str:
        digits = f"{self.identifier & ~EXTENDED:08X}" if self.identifier & EXTENDED else f"{self.identifier:03X}"
        data = "".join("xx" if byte is None else f"{byte:02X}" for byte in self.data)
        return f"{f'{self.channel}:' if self.channel else ''}{digits}{f'#{data}' if data else ''}"


def parse_marker(text: str) -> Marker:
    """A marker as users write it: an identifier in hexadecimal, as candump shows it, with a bus and the first bytes if they matter.

    Identifiers with more than three digits, or above 7FF, have 29 bits.

    Raises
    ------
    ValueError : the text is no marker.
    """
    found = _FORM.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"{text!r} is not a marker of the form {FORM}; {_EXAMPLE}")
    number = int(found["id"], 16)
    if number > _LARGEST:
        raise ValueError(f"the identifier {found['id']} has more than 29 bits; the largest is {_LARGEST:X}")
    is_extended = number > _STANDARD or len(found["id"]) > 3
    pairs = re.findall("..", found["data"] or "")
    data = tuple(None if pair in ("xx", "XX", "xX", "Xx") else int(pair, 16) for pair in pairs)
    return Marker(number | (EXTENDED if is_extended else 0), data, found["channel"])


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerCounter:
    """The number of the job in a payload, which counts up.

    Attributes
    ----------
    modulus : after so many numbers it starts again from 0
    """

    decode: Decoder = field(compare=False)
    modulus: int


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerPair:
    """An object whose start and end are frames.

    Attributes
    ----------
    counter : None if the frames have no number
    period : the standard period; None if it is not stated
    baseline : name of the object whose times are subtracted; None: nothing is
    """

    name: str
    start: Marker
    end: Marker
    kind: MeasuredKind = MeasuredKind.INTERVAL
    quantity: str = "duration"
    counter: MarkerCounter | None = None
    period: Time | None = None
    baseline: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerChain:
    """A chain from a stimulus to a response that are frames.

    Attributes
    ----------
    counter : in the frames of both: the number of the stimulus; None if there is none
    """

    name: str
    stimulus: Marker
    response: Marker
    counter: MarkerCounter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportedValue:
    """Times that the controller measures itself, and sends one by one.

    Attributes
    ----------
    value : picoseconds
    """

    name: str
    marker: Marker
    value: Decoder = field(compare=False)
    kind: MeasuredKind = MeasuredKind.INTERVAL
    quantity: str = "duration"
    baseline: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportedStatistics:
    """Statistics that the controller computes itself, for example over a second, and sends.

    Attributes
    ----------
    min, mean, max, deviation : picoseconds; None: not sent
    count : of the values; None: not sent
    """

    name: str
    marker: Marker
    min: Decoder = field(compare=False)
    mean: Decoder = field(compare=False)
    max: Decoder = field(compare=False)
    deviation: Decoder | None = field(default=None, compare=False)
    count: Decoder | None = field(default=None, compare=False)
    kind: MeasuredKind = MeasuredKind.INTERVAL
    quantity: str = "duration"
    baseline: str | None = None


def refuse_overlap(first: Marker, second: Marker) -> None:
    """Refuse two markers that one frame can be.

    Raises
    ------
    ValueError : it would not be known which of them it is.
    """
    if first.overlaps(second):
        raise ValueError(f"a frame can be both {first} and {second}; give first bytes that differ, e.g. 123#01 and 123#02")


Measurable: TypeAlias = MarkerPair | MarkerChain | ReportedValue | ReportedStatistics
