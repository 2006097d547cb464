"""One line of candump: those of log files, those of its console, and its notes.

After `candump.c` and `lib.c` of can-utils. Frames of log files have no blank between identifier and data, such as `123#1122`; those of
the console look like `123   [2]  11 22`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime

from amalthea_uros.trace.can.frames import EXTENDED, XL, FrameKind
from amalthea_uros.trace.files import UnreadableError

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
_DROPPED = re.compile(r"DROPCOUNT: dropped (\d+) CAN frames? on '([^',]*)[^']*' socket \(total drops -?\d+\)")
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
    """What a line says.

    Attributes
    ----------
    stamp : None if it has none, as lost frames do
    lost : of a gap: the number of frames that are lost
    """

    stamp: Stamp | None
    channel: str
    identifier: int
    kind: FrameKind
    data: bytes = b""
    lost: int = 0


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
        return CandumpLine(None, match[2], 0, FrameKind.GAP, lost=int(match[1][:18]))
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
