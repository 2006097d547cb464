"""The messages of a DBC file as foreign frames on a CAN bus."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros.diagnostics import Location
from amalthea_uros.trace.can.dbc import DbcMessage, read_dbc
from amalthea_uros.trace.can.frames import EXTENDED
from amalthea_uros.uros.transports.can import ForeignFrame


def frames_of(path: Path, stated: Location | None) -> tuple[ForeignFrame, ...]:
    """The frames that a DBC file defines.

    Parameters
    ----------
    stated : where a description names the file

    Raises
    ------
    ReadError : it is not a DBC file.
    InvalidArgumentError : cantools is not installed.
    """
    return tuple(_frame(message, stated) for message in read_dbc(path).messages.values())


def _frame(message: DbcMessage, stated: Location | None) -> ForeignFrame:
    return ForeignFrame(
        name=message.name,
        identifier=message.identifier & ~EXTENDED,
        extended=bool(message.identifier & EXTENDED),
        data_bytes=message.length,
        period=message.cycle_time,
        origin=stated,
    )
