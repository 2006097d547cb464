"""Lines of candump: the usual form many at a time, by columns of characters, and one line of any form.

After `candump.c` and `lib.c` of can-utils. Frames of log files have no blank between identifier and data, such as `123#1122`; those of
the console look like `123   [2]  11 22`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass
from amalthea_uros.trace.can.frames import EXTENDED, XL, FrameKind
from amalthea_uros.trace.files import UnreadableError

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Largest number of bytes of a frame of CAN, CAN FD and CAN XL.
_CLASSIC, _FLEXIBLE, _LARGE = 8, 64, 2048
#: In an identifier that candump writes with eight digits: the frame is a message of the controller about errors.
_ERROR = 0x2000_0000
_MASK = 0x1FFF_FFFF
_MAX_STANDARD = 0x7FF
_PICOSECONDS = 12
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)

_HEX = "(?:[0-9A-Fa-f]{2}\\.?)*"
_IDENTIFIER = "([0-9A-Fa-f]{8}|[0-9A-Fa-f]{3})"
_COLOUR = re.compile("\x1b\\[[0-9;]*m")
_LOG = re.compile(r"\(([^)]*)\) +(\S+) +([0-9A-Fa-f]{3,8}#\S*)(?: [RT])?")
_CONSOLE = re.compile(
    rf"(?:\(([^)]*)\) +)?(\S+) +(?:[RT]X +[B-] [E-] +)?{_IDENTIFIER} +(?:\[(\d+)\]|\{{[9A-Fa-f]\}}) *(.*)", re.DOTALL
)
_CONSOLE_DATA = re.compile(r"((?:(?:[01]{8}|[0-9A-Fa-f]{2})(?:[ `]|$))*) *(?:ERRORFRAME|['`].*)?", re.DOTALL)
_DROPPED = re.compile(r"DROPCOUNT: dropped \d+ CAN frames? on '([^',]*)[^']*' socket \(total drops -?\d+\)")
_DATA = re.compile(rf"{_IDENTIFIER}#({_HEX})(?:_[9A-Fa-f])?")
_REMOTE = re.compile(rf"{_IDENTIFIER}#R[0-8]?(?:_[9A-Fa-f])?")
_FD = re.compile(rf"{_IDENTIFIER}##[0-9A-Fa-f]({_HEX})")
_XL = re.compile(rf"[0-9A-Fa-f]{{2}}([0-9A-Fa-f]{{3}})#[0-9A-Fa-f]{{2}}:[0-9A-Fa-f]{{2}}:[0-9A-Fa-f]{{8}}#({_HEX})")
_STAMP = re.compile(r"([0-9]{1,10})\.([0-9]{1,12})", re.ASCII)
_DATE = re.compile(r"([0-9]{4}-[0-9]{2}-[0-9]{2} [0-9]{2}:[0-9]{2}:[0-9]{2})\.([0-9]{1,12})", re.ASCII)

_NO_STAMP = "a frame has no time stamp; it is ignored"
_NOT_A_FRAME = "a line is not a frame of candump; it is ignored"


@dataclass(frozen=True, slots=True)
class Stamp:
    """The time of a line.

    Attributes
    ----------
    time : picoseconds
    step : the last digit, in picoseconds
    digits : of the whole seconds; candump writes at least ten if the time is absolute, three if it is relative
    is_local : whether it is a date, in a time zone that is not known
    """

    time: int
    step: int
    digits: int
    is_local: bool = False


@dataclass(frozen=True, slots=True)
class CandumpLine:
    """What a line says; lost frames have no time stamp."""

    stamp: Stamp | None
    channel: str
    identifier: int
    kind: FrameKind
    data: bytes = b""


def parse(text: str) -> CandumpLine:
    """What a line without its end says.

    Raises
    ------
    UnreadableError : nothing that can be used.
    """
    text = _COLOUR.sub("", text).strip(" ")
    if match := _LOG.fullmatch(text):
        return CandumpLine(stamp_of(match[1]), match[2], *_frame(match[3]))
    if match := _CONSOLE.fullmatch(text):
        if match[1] is None:
            raise UnreadableError(_NO_STAMP)
        length = _CLASSIC if match[4] is None else int(match[4][:5])
        return CandumpLine(stamp_of(match[1]), match[2], *_console_frame(match[3], length, match[5]))
    if match := _DROPPED.fullmatch(text):
        return CandumpLine(None, match[1], 0, FrameKind.GAP)
    raise UnreadableError(_NOT_A_FRAME)


def is_frame(text: str) -> bool:
    """Whether a line without its end is a frame."""
    try:
        return parse(text).kind is not FrameKind.GAP
    except UnreadableError:
        return False


def stamp_of(text: str) -> Stamp:
    """The time in the parentheses of a line.

    Raises
    ------
    UnreadableError : it is none.
    """
    if match := _STAMP.fullmatch(text):
        seconds = int(match[1])
    elif match := _DATE.fullmatch(text):
        seconds = _seconds_of_date(match[1])
    else:
        raise UnreadableError(_NOT_A_FRAME)
    step = 10 ** (_PICOSECONDS - len(match[2]))
    return Stamp(seconds * 10**_PICOSECONDS + int(match[2]) * step, step, len(match[1]), match.re is _DATE)


def _seconds_of_date(text: str) -> int:
    try:
        date = datetime.strptime(text, "%Y-%m-%d %H:%M:%S").replace(tzinfo=UTC)
    except ValueError:
        raise UnreadableError(_NOT_A_FRAME) from None
    return round((date - _EPOCH).total_seconds())


def _frame(text: str) -> tuple[int, FrameKind, bytes]:
    """Identifier, kind and data of a frame of a log file."""
    for pattern, limit in ((_DATA, _CLASSIC), (_FD, _FLEXIBLE)):
        if match := pattern.fullmatch(text):
            return *_identified(match[1]), _bytes(match[2], limit)
    if match := _REMOTE.fullmatch(text):
        return _identified(match[1])[0], FrameKind.REMOTE, b""
    if match := _XL.fullmatch(text):
        return XL | _standard(int(match[1], 16)), FrameKind.DATA, _bytes(match[2], _LARGE)
    raise UnreadableError(_NOT_A_FRAME)


def _console_frame(identifier: str, length: int, text: str) -> tuple[int, FrameKind, bytes]:
    number, kind = _identified(identifier)
    if text.startswith("remote request"):
        return number, FrameKind.REMOTE, b""
    match = _CONSOLE_DATA.fullmatch(text)
    parts = re.split("[ `]", match[1].strip(" `")) if match and match[1] else []
    if match is None or len(parts) != length or length > _FLEXIBLE:
        raise UnreadableError(_NOT_A_FRAME)
    data = bytes(int(part, 2 if len(part) == 8 else 16) for part in parts)
    # The byte order is turned around with -S, which has its own mark between the bytes.
    return number, kind, data[::-1] if "`" in match[1].strip(" `") else data


def _identified(digits: str) -> tuple[int, FrameKind]:
    number = int(digits, 16)
    if len(digits) == 3:
        return _standard(number), FrameKind.DATA
    if number & ~(_MASK | _ERROR):
        raise UnreadableError(_NOT_A_FRAME)
    return (number & _MASK, FrameKind.ERROR) if number & _ERROR else (number | EXTENDED, FrameKind.DATA)


def _standard(number: int) -> int:
    if number > _MAX_STANDARD:
        raise UnreadableError(_NOT_A_FRAME)
    return number


def _bytes(text: str, limit: int) -> bytes:
    data = bytes.fromhex(text.replace(".", ""))
    if len(data) > limit:
        raise UnreadableError(_NOT_A_FRAME)
    return data


# Many lines at a time, of the usual form `(1436509052.249713) can0 123#11223344`; the others are left to `parse`, and what both accept,
# they read alike.


#: An element of an array.
Number = TypeVar("Number", bound="np.integer[Any]")

_DIGIT = np.full(256, 99, np.int64)
_DIGIT[[*b"0123456789"]] = range(10)
_HEX_DIGIT = np.full(256, 99, np.int64)
_HEX_DIGIT[[*b"0123456789abcdef"]] = range(16)
_HEX_DIGIT[[*b"ABCDEF"]] = range(10, 16)
_MAX_SECONDS_DIGITS, _MAX_DATA_DIGITS, _MAX_NAMES = 10, 16, 64


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
        digit = np.where(end - 1 - place >= start, _HEX_DIGIT[_at(text, end - 1 - place)], 0)
        is_valid &= digit < 16
        number += digit << (4 * place)
    is_valid &= number <= np.where(is_short, _MAX_STANDARD, _MASK)
    return np.where(is_short, number, number | EXTENDED), is_valid


def _data(text: NDArray[np.uint8], start: Numbers, end: Numbers, is_plain: Flags) -> tuple[NDArray[np.uint8], Numbers, Flags]:
    digits = end - start
    is_valid = (digits >= 0) & (digits % 2 == 0) & (digits <= _MAX_DATA_DIGITS)
    width = max(int(digits[is_valid & is_plain].max(initial=0)) // 2, 1)
    data = np.zeros((len(start), width), np.uint8)
    for byte in range(width):
        is_there = start + 2 * byte < end
        high, low = (np.where(is_there, _HEX_DIGIT[_at(text, start + 2 * byte + nibble)], 0) for nibble in (0, 1))
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
