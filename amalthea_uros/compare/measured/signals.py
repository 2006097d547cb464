"""Values in the payloads of frames: some bytes, or the signals that a DBC file describes."""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.markers import Decoder, Marker

if TYPE_CHECKING:
    from amalthea_uros.trace.can.dbc import DbcDatabase

#: How some bytes are written; the first one is byte 0.
_BYTES = re.compile(r"bytes? (\d{1,2})(?:\.\.(\d{1,2}))?(?: (big|little))?")
#: Bytes of the payload of a CAN FD frame.
_LONGEST = 64
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


class Signals:
    """What payloads contain.

    Parameters
    ----------
    path : the DBC file; None: only bytes are known
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path

    @cached_property
    def _database(self) -> DbcDatabase:
        if self._path is None:
            raise InvalidArgumentError("signals need the description of the bus; add --dbc FILE")
        from amalthea_uros.trace.can.dbc import read_dbc

        return read_dbc(self._path)

    def value(self, text: str) -> Value:
        """What a text refers to.

        Raises
        ------
        ValueError : it is neither bytes nor a signal that is known.
        ReadError : the DBC file cannot be read.
        """
        found = _BYTES.fullmatch(text)
        if found is not None:
            first, last = int(found[1]), int(found[2] or found[1])
            if not first <= last < first + 8 or last >= _LONGEST:
                raise ValueError(f"{text!r} is not a range of one to eight bytes of a payload")
            return Value(_bytes(first, last, found[3] == "big"), 8 * (last - first + 1))
        if "." not in text:
            raise ValueError(f"{text!r} is not a place in a payload; expected {FORM}")
        message, signal = self._database.find(text)
        return Value(signal.value, signal.bits, Marker(message.identifier))


def _bytes(first: int, last: int, is_big: bool) -> Decoder:
    def decode(data: bytes) -> Fraction | None:
        if len(data) <= last:
            return None
        return Fraction(int.from_bytes(data[first : last + 1], "big" if is_big else "little"))

    return decode
