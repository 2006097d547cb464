"""Frames of CAN buses in time, as a table of columns: what a log file contains."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import TYPE_CHECKING

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.files import TracePlace, TraceProblems

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: Bit of an identifier that says that it has 29 bits: 0x123 and 0x00000123 are different ones.
EXTENDED = 1 << 31
#: Bit that says that it is a frame of CAN XL, which has a priority in the place of an identifier.
XL = 1 << 32


#: Index of the channel of a gap of which it is not known on which bus it is.
UNKNOWN = -1


class FrameKind(IntEnum):
    """What a row of a log is; a gap is where frames are lost: the recorder says so, or a line cannot be read."""

    DATA = 0
    REMOTE = 1
    ERROR = 2
    GAP = 3


@dataclass(frozen=True, slots=True)
class FrameTable:
    """Some frames, in the order of the log: time may step back where a clock does.

    Attributes
    ----------
    channels : names of the buses, the same for all tables of a log so far
    time : picoseconds from the origin of the log, int64; of a gap, that of the frame before it
    channel : index into `channels`, int16; `UNKNOWN` of some gaps
    identifier : with the bit `EXTENDED` if it has 29 bits, or `XL`; of an error the bits of its class; of a gap 0; int64
    kind : of `FrameKind`, int8
    line : number of the line or of the record in the file, from 1, int64
    data : the payload of each frame
    """

    channels: Sequence[str]
    time: Numbers
    channel: NDArray[np.int16]
    identifier: Numbers
    kind: NDArray[np.int8]
    line: Numbers
    data: Sequence[bytes]

    def __len__(self) -> int:
        return len(self.time)

    def take(self, places: Numbers) -> FrameTable:
        """The rows at some places, in that order."""
        return FrameTable(
            self.channels,
            self.time[places],
            self.channel[places],
            self.identifier[places],
            self.kind[places],
            self.line[places],
            [self.data[place] for place in places.tolist()],
        )


# Error frames: what the controller says about the bus, and frames that it lost (`linux/can/error.h`).

#: Bits of the class; the second byte says which problem a controller has.
_CLASSES = {
    0x001: "timeout of a transmission",
    0x002: "lost arbitration",
    0x004: "problem of the controller",
    0x008: "violation of the protocol",
    0x010: "problem of the transceiver",
    0x020: "no acknowledgement",
    0x040: "bus off",
    0x080: "bus error",
    0x100: "restarted after bus off",
    0x200: "error counters",
}
_CONTROLLER = 0x004
_RECEIVE_OVERFLOW = 0x01


def is_receive_overflow(classes: int, data: bytes) -> bool:
    """Whether the controller has lost received frames."""
    return bool(classes & _CONTROLLER and len(data) > 1 and data[1] & _RECEIVE_OVERFLOW)


def report_error(problems: TraceProblems, classes: int, data: bytes, place: TracePlace) -> None:
    """Report an error frame."""
    if is_receive_overflow(classes, data):
        message = "the receive buffer of the controller was full, so frames are missing"
        problems.add("CAN003", Severity.WARNING, message, place, _LOST_ADVICE)
        return
    names = ", ".join(name for bit, name in _CLASSES.items() if classes & bit)
    problems.add(
        "CAN004",
        Severity.WARNING,
        f"error frame: {names}" if names else "error frame",
        place,
        "Check the wiring, the bit rate and the load of the bus.",
    )


def report_lost(problems: TraceProblems, place: TracePlace) -> None:
    """Report frames that the recorder has lost."""
    message = "frames were dropped while recording; nothing is known of that time"
    problems.add("CAN003", Severity.WARNING, message, place, _LOST_ADVICE)


_LOST_ADVICE = "Record with a larger buffer (candump -r), with filters, or on a less busy computer."
