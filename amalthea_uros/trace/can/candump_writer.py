"""Traces as candump would log them if each start and end of a task or ISR were a frame on a debug bus: as on real controllers.

Beside the log goes a file with the identifiers, in the form that `amuros measure --markers` reads. The stamps are microseconds, rounded
down, as candump writes them; the payload is the number of the job, four bytes with the least significant one first. Neither the time of
sending nor the bus is modelled: a stamp is when the event occurs.
"""

from __future__ import annotations

import re

from amalthea_uros.trace.sinks import Encoder
from amalthea_uros.trace.table import EntityKind, EventKind, EventTable

#: The identifiers from here on are used, as in the measurements of the thesis.
_FIRST = 0x1800_0001
_CHANNEL = "can0"
_MICROSECOND, _SECOND = 10**6, 10**12
_JOBS = 1 << 32
_PROCESSES = (EntityKind.TASK, EntityKind.ISR)
_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
#: Names that YAML takes for something else.
_WORDS = frozenset(["y", "n", "yes", "no", "on", "off", "true", "false", "null"])


class CandumpEncoder(Encoder):
    """Makes the lines of a log."""

    def encode(self, table: EventTable) -> bytes:
        """The lines of the starts and ends among some events."""
        lines = []
        columns = (table.time, table.kind, table.target, table.target_instance)
        for time, kind, target, job in zip(*(column.tolist() for column in columns), strict=True):
            if kind in (EventKind.START, EventKind.TERMINATE):
                start, end = _identifiers(target)
                seconds, rest = divmod(time, _SECOND)
                payload = (job % _JOBS).to_bytes(4, "little").hex().upper()
                identifier = start if kind == EventKind.START else end
                lines.append(f"({seconds:010}.{rest // _MICROSECOND:06}) {_CHANNEL} {identifier:08X}#{payload}\n")
        return "".join(lines).encode()

    def companion(self) -> tuple[str, bytes]:
        """The end of the name of the file with the identifiers, and its content."""
        lines = [
            f"{_key(entity.name)}: {{start: 0x{start:08X}, end: 0x{end:08X}, counter: bytes 0..3, "
            "kind: process, quantity: gross_execution_time}\n"
            for number, entity in enumerate(self._entities)
            if entity.kind in _PROCESSES
            for start, end in (_identifiers(number),)
        ]
        return ".markers.yaml", "".join(lines).encode()


def _identifiers(entity: int) -> tuple[int, int]:
    return _FIRST + 2 * entity, _FIRST + 2 * entity + 1


def _key(name: str) -> str:
    """A name as a key in YAML."""
    if _PLAIN.fullmatch(name) and name.lower() not in _WORDS:
        return name
    # Characters that YAML does not allow in a file have a number of eight digits.
    characters = (f"\\U{ord(each):08X}" if not each.isprintable() or each in '"\\' else each for each in name)
    return f'"{"".join(characters)}"'
