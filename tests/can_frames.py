"""What logs of CAN buses contain, as rows."""

from collections.abc import Iterable
from pathlib import Path

from amalthea_uros.trace.can.frames import EXTENDED, UNKNOWN, FrameKind, FrameTable
from amalthea_uros.trace.can.logs import CanLog, open_can_log

SECOND, MS, US = 10**12, 10**9, 10**6
DATA, REMOTE, ERROR, GAP = FrameKind


def rows(tables: Iterable[FrameTable]) -> list[tuple]:
    """Time, channel, identifier, kind and data of all frames."""
    found = []
    for table in tables:
        columns = [column.tolist() for column in (table.time, table.channel, table.identifier, table.kind)]
        for time, channel, identifier, kind, data in zip(*columns, table.data, strict=True):
            found.append(
                (time, "" if channel == UNKNOWN else table.channels[channel], identifier, FrameKind(kind), bytes(data))
            )
    return found


def read(path: Path, content: str | bytes, **options) -> tuple[list[tuple], CanLog]:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    log = open_can_log(path, **options)
    return rows(log), log


def rules(log: CanLog) -> list[str]:
    return [finding.rule for finding in log.findings]


__all__ = ["DATA", "ERROR", "EXTENDED", "GAP", "MS", "REMOTE", "SECOND", "US", "read", "rows", "rules"]
