"""Many lines of candump at a time: the usual form `(1436509052.249713) can0 123#11223344`, by columns of characters.

CandumpLines of any other form are left to `candump_lines`; what both accept, they read alike.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros.trace.can.frames import EXTENDED

if TYPE_CHECKING:
    from numpy.typing import NDArray


#: An element of an array.
Number = TypeVar("Number", bound="np.integer[Any]")

_DIGIT = np.full(256, 99, np.int64)
_DIGIT[[*b"0123456789"]] = range(10)
_HEX = np.full(256, 99, np.int64)
_HEX[[*b"0123456789abcdef"]] = range(16)
_HEX[[*b"ABCDEF"]] = range(10, 16)
_MAX_SECONDS_DIGITS, _MAX_DATA_DIGITS, _MAX_NAMES = 10, 16, 64
_MAX_STANDARD, _MAX_EXTENDED = 0x7FF, 0x1FFF_FFFF


@dataclass(frozen=True, slots=True)
class CandumpLines:
    """The lines of a block, an element each; apart from the first three, those of lines that are not plain mean nothing.

    Attributes
    ----------
    start, end : the places of the line in the block, without its end
    is_plain : whether the line has the usual form
    seconds : of the time
    fraction : of a second, in nanoseconds
    has_nanoseconds : whether the fraction has nine digits instead of six
    channel : index that the names were given
    identifier : as in a table of frames
    length : of the data
    data : of each line, with zeros up to the largest length
    """

    start: Numbers
    end: Numbers
    is_plain: Flags
    seconds: Numbers
    fraction: Numbers
    has_nanoseconds: Flags
    channel: NDArray[np.int16]
    identifier: Numbers
    length: Numbers
    data: NDArray[np.uint8]

    def payloads(self) -> list[bytes]:
        """The data of all lines."""
        width = self.data.shape[1]
        flat = self.data.tobytes()
        starts = range(0, len(self.length) * width, width)
        return [flat[start : start + length] for start, length in zip(starts, self.length.tolist(), strict=True)]


def read_lines(block: bytes, channel_index: Callable[[str], int]) -> CandumpLines:
    """The lines of a block, of which each ends with a line end."""
    text = np.frombuffer(block, np.uint8)
    end = np.flatnonzero(text == ord("\n"))
    start = np.concatenate(([0], end[:-1] + 1))
    end = end - (_at(text, end - 1) == ord("\r")) * (end > start)
    # The direction at the end is not needed.
    has_direction = (_at(text, end - 2) == ord(" ")) & np.isin(_at(text, end - 1), [*b"RT"]) & (end - start > 2)
    data_end = end - 2 * has_direction

    close, hash_ = _next(text, ")", start), _next(text, "#", start)
    blanks = np.flatnonzero(text == ord(" "))
    before_frame = np.searchsorted(blanks, hash_) - 1
    before_name = before_frame - 1
    is_plain = (_at(text, start) == ord("(")) & (close < hash_) & (hash_ < data_end) & (before_name >= 0)
    identifier_start, name_start = _at(blanks, before_frame) + 1, _at(blanks, before_name) + 1
    # Names are aligned to the right: between the time and the name is nothing but blanks.
    is_plain &= (name_start > close) & (np.searchsorted(blanks, close) + (name_start - close - 2) == before_name)

    seconds, fraction, has_nanoseconds, is_time = _times(text, start, close)
    identifier, is_identifier = _identifiers(text, identifier_start, hash_)
    data, length, is_data = _data(text, hash_ + 1, data_end, is_plain)
    is_plain &= is_time & is_identifier & is_data
    channel, is_known = _channels(text, block, (name_start, identifier_start - 1), is_plain, channel_index)
    length = np.where(is_plain & is_known, length, 0)
    return CandumpLines(start, end, is_plain & is_known, seconds, fraction, has_nanoseconds, channel, identifier, length, data)


def _at(values: NDArray[Number], places: Numbers) -> NDArray[Number]:
    """The values at some places; those outside are moved to the edge, and must not be used."""
    return np.take(values, places, mode="clip") if len(values) else np.zeros(len(places), values.dtype)


def _next(text: NDArray[np.uint8], character: str, places: Numbers) -> Numbers:
    """Where a character is, from each place on; the end of the text if it does not come again."""
    found = np.append(np.flatnonzero(text == ord(character)), len(text))
    return found[np.searchsorted(found, places)]


def _times(text: NDArray[np.uint8], start: Numbers, close: Numbers) -> tuple[Numbers, Numbers, Flags, Flags]:
    """Whole seconds, nanoseconds, whether there are nine digits of them, and whether it is a time at all."""
    has_micros = _at(text, close - 7) == ord(".")
    dot = np.where(has_micros, close - 7, close - 10)
    is_time = (_at(text, dot) == ord(".")) & (dot > start + 1) & (dot - start - 1 <= _MAX_SECONDS_DIGITS)
    seconds = np.zeros(len(start), np.int64)
    for place in range(_MAX_SECONDS_DIGITS):
        at = dot - 1 - place
        digit = np.where(at > start, _DIGIT[_at(text, at)], 0)
        is_time &= digit < 10
        seconds += digit * 10**place
    fraction = np.zeros(len(start), np.int64)
    for place in range(9):
        digit = np.where(dot + 1 + place < close, _DIGIT[_at(text, dot + 1 + place)], 0)
        is_time &= digit < 10
        fraction += digit * 10 ** (8 - place)
    return seconds, fraction, ~has_micros, is_time


def _identifiers(text: NDArray[np.uint8], start: Numbers, end: Numbers) -> tuple[Numbers, Flags]:
    digits = end - start
    is_short = digits == 3
    number, is_valid = np.zeros(len(start), np.int64), is_short | (digits == 8)
    for place in range(8):
        digit = np.where(end - 1 - place >= start, _HEX[_at(text, end - 1 - place)], 0)
        is_valid &= digit < 16
        number += digit << (4 * place)
    is_valid &= number <= np.where(is_short, _MAX_STANDARD, _MAX_EXTENDED)
    return np.where(is_short, number, number | EXTENDED), is_valid


def _data(text: NDArray[np.uint8], start: Numbers, end: Numbers, is_plain: Flags) -> tuple[NDArray[np.uint8], Numbers, Flags]:
    digits = end - start
    is_valid = (digits >= 0) & (digits % 2 == 0) & (digits <= _MAX_DATA_DIGITS)
    width = max(int(digits[is_valid & is_plain].max(initial=0)) // 2, 1)
    data = np.zeros((len(start), width), np.uint8)
    for byte in range(width):
        is_there = start + 2 * byte < end
        high, low = (np.where(is_there, _HEX[_at(text, start + 2 * byte + nibble)], 0) for nibble in (0, 1))
        is_valid &= (high < 16) & (low < 16)
        data[:, byte] = (high << 4 | low) & 0xFF
    return data, digits // 2, is_valid


def _channels(
    text: NDArray[np.uint8], block: bytes, name: tuple[Numbers, Numbers], is_plain: Flags, channel_index: Callable[[str], int]
) -> tuple[NDArray[np.int16], Flags]:
    """The channel of each line, and whether it is known; a block with a great many names is not worth columns."""
    start, end = name
    channel, is_open = np.zeros(len(start), np.int16), is_plain & (end > start)
    is_known = np.zeros(len(start), np.bool_)
    for _ in range(_MAX_NAMES):
        first = int(np.argmax(is_open))
        if not len(start) or not is_open[first]:
            break
        word = block[start[first] : end[first]]
        is_same = is_open & (end - start == len(word))
        for place, character in enumerate(word):
            is_same &= _at(text, start + place) == character
        index = channel_index(word.decode(errors="replace"))
        channel[is_same] = index
        is_known |= is_same & (index >= 0)
        is_open &= ~is_same
    return channel, is_known
