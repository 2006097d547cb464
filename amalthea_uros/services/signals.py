"""Values in the payloads of frames: some bytes, or the signals that a DBC file describes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from amalthea_uros.measure.markers import Decoder, Marker

#: How some bytes are written; the first one is byte 0.
_BYTES = re.compile(r"bytes? (\d{1,2})(?:\.\.(\d{1,2}))?(?: (big|little))?")
FORM = "'byte 0', 'bytes 0..3', 'bytes 0..3 big' (little endian otherwise), or a signal of a DBC file: 'Message.Signal'"


@dataclass(frozen=True, slots=True)
class Value:
    """Where a value is.

    Attributes
    ----------
    bits : its size
    marker : the frames that have the signal; None for bytes
    """

    decode: Decoder
    bits: int
    marker: Marker | None = None


@dataclass(frozen=True, slots=True)
class Signals:
    """What payloads contain.

    Attributes
    ----------
    path : the DBC file; None: only bytes are known
    """

    path: Path | None

    def value(self, text: str) -> Value:
        """What a text refers to.

        Raises
        ------
        ValueError : it is neither bytes nor a signal.
        ReadError : the DBC file cannot be read.
        """
        found = _BYTES.fullmatch(text)
        if found is not None:
            first, last = int(found[1]), int(found[2] or found[1])
            if not first <= last < first + 8 <= 72:
                raise ValueError(f"{text!r} is not a range of one to eight bytes of a payload")
            return Value(_bytes(first, last, found[3] == "big"), 8 * (last - first + 1))
        raise ValueError(f"{text!r} is not a place in a payload; expected {FORM}")


def _bytes(first: int, last: int, is_big: bool) -> Decoder:
    def decode(data: bytes) -> Fraction | None:
        if len(data) <= last:
            return None
        return Fraction(int.from_bytes(data[first : last + 1], "big" if is_big else "little"))

    return decode
