"""Frames of CAN buses in time, as a table of columns: what a log file contains."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Protocol

from amalthea_uros.diagnostics import Finding

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: Bit of an identifier that says that it has 29 bits: 0x123 and 0x00000123 are different ones.
EXTENDED = 1 << 31


class FrameKind(IntEnum):
    """What a row of a log is; a gap stands where the recorder says that it lost frames."""

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
    time : picoseconds, as the log states them, int64
    channel : index into `channels`, int16
    identifier : with the bit `EXTENDED` if it has 29 bits, int64
    kind : of `FrameKind`, int8
    line : number of the line or of the record in the file, from 1, int64
    data : the payload of each frame
    """

    channels: Sequence[str]
    time: NDArray[np.int64]
    channel: NDArray[np.int16]
    identifier: NDArray[np.int64]
    kind: NDArray[np.int8]
    line: NDArray[np.int64]
    data: Sequence[bytes]

    def __len__(self) -> int:
        return len(self.time)


class CanLog(Protocol):
    """Gives the frames of a log file; it can be used once.

    Attributes
    ----------
    findings : the problems met so far; everything else has been read
    resolution : smallest step of the time stamps in picoseconds; None if the format does not say
    """

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""

    @property
    def resolution(self) -> int | None:
        """The step of the time stamps."""

    def __iter__(self) -> Iterator[FrameTable]:
        """The frames, in consecutive tables."""
