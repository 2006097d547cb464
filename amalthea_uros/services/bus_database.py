"""The frames of others on a CAN bus, from the DBC file that a description names."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.description import Description
from amalthea_uros.trace.can.dbc import DbcMessage, read_dbc
from amalthea_uros.trace.can.frames import EXTENDED
from amalthea_uros.uros.transports.foreign import ForeignFrame


def database_frames(description: Description, folder: Path) -> tuple[ForeignFrame, ...]:
    """The frames of the database; none without one.

    Parameters
    ----------
    folder : what the path of the file is relative to

    Raises
    ------
    ReadError : there is no such file, or it is not a DBC file.
    InvalidArgumentError : cantools is not installed.
    """
    transport = description.middleware.transport
    bus = transport.can or transport.can_fd
    if bus is None or bus.dbc is None:
        return ()
    path, stated = folder / bus.dbc, bus.location("dbc")
    if not path.is_file():
        advice = "Give a path relative to the directory of this file."
        raise ReadError([Finding("APP001", Severity.ERROR, f"DBC file {str(path)!r} not found", stated, advice)])
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
