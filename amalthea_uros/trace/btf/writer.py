"""Traces as BTF 2.3.0 (Best Trace Format), with names or with numbers for entities; events of chains are left out."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from amalthea_uros._version import __version__
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.btf.header import TIMESCALES, escape
from amalthea_uros.trace.sinks import Encoder, WriteOptions
from amalthea_uros.trace.table import NO_NOTE, Entity, EntityKind, EventTable
from amalthea_uros.trace.vocabulary import OS_EVENTS, WORDS

#: The types in files, at the places of their numbers.
_TYPES: list[EntityKind] = [kind for kind in EntityKind if kind is not EntityKind.CHAIN]
_KNOWN = np.array(sorted(WORDS))
_ENDINGS = {int(kind): f",{word}\n" for kind, word in WORDS.items()}


class BtfEncoder(Encoder):
    """Makes the lines of a BTF file.

    Raises
    ------
    InvalidArgumentError : there is no such unit of time.
    """

    def __init__(self, entities: Sequence[Entity], options: WriteOptions) -> None:
        if options.timescale not in TIMESCALES:
            raise InvalidArgumentError(
                f"BTF has no timescale {options.timescale!r}; expected one of {', '.join(TIMESCALES)}, e.g. ns"
            )
        super().__init__(entities, options)
        self._scale = TIMESCALES[options.timescale]
        self._fields: list[str] = []
        self._targets: list[str] = []

    def begin(self) -> bytes:
        """The header."""
        lines = ["#version 2.3.0", f"#creator amuros {__version__}"]
        if self._options.creation_date is not None:
            lines.append(f"#creationDate {_utc(self._options.creation_date)}")
        lines.append(f"#timescale {self._options.timescale}")
        if self._options.numeric:
            lines += [f"#typeMapping {number} {kind}" for number, kind in enumerate(_TYPES)]
        return _joined(lines + self._mappings_of_new_entities())

    def encode(self, table: EventTable) -> bytes:
        """The lines of some events, after the names and types of new entities.

        Raises
        ------
        InvalidArgumentError : a time is not a whole number of the unit.
        """
        mappings = self._mappings_of_new_entities()
        is_known = np.isin(table.kind, _KNOWN)
        if not is_known.all():
            table = table.where(is_known)
        times = table.time
        if self._scale > 1:
            times, rest = np.divmod(times, self._scale)
            if rest.any():
                raise InvalidArgumentError(
                    f"the time {table.time[rest > 0][0]} ps is not a whole number of {self._options.timescale}; "
                    "use a finer timescale, e.g. ps"
                )
        fields, targets = self._fields, self._targets
        rows = zip(
            times.tolist(),
            [fields[source] for source in table.source.tolist()],
            table.source_instance.tolist(),
            [targets[target] for target in table.target.tolist()],
            table.target_instance.tolist(),
            self._endings(table),
            strict=True,
        )
        lines = "".join(
            [f"{time},{source},{job},{target}{number}{ending}" for time, source, job, target, number, ending in rows]
        )
        return _joined(mappings) + lines.encode()

    def _mappings_of_new_entities(self) -> list[str]:
        lines = []
        for number in range(len(self._fields), len(self._entities)):
            entity = self._entities[number]
            name = escape(entity.name)
            field = str(number) if self._options.numeric else name
            is_known = entity.kind in _TYPES
            kind = str(_TYPES.index(entity.kind)) if self._options.numeric and is_known else entity.kind.value
            if is_known and self._options.numeric:
                lines.append(f"#entityMapping {number} {name}")
            if is_known:
                lines.append(f"#entityTypeMapping {kind} {field}")
            self._fields.append(field)
            self._targets.append(f"{kind},{field},")
        return lines

    def _endings(self, table: EventTable) -> list[str]:
        """The last fields of the events: the word, and the note if there is one."""
        kinds = table.kind.tolist()
        endings = [_ENDINGS[kind] for kind in kinds]
        for row in np.flatnonzero(table.note != NO_NOTE).tolist():
            note = int(table.note[row])
            # The standard wants the owner of an OS event there.
            text = self._fields[note] if kinds[row] in OS_EVENTS else str(note)
            endings[row] = f"{endings[row][:-1]},{text}\n"
        return endings


def _utc(date: datetime) -> str:
    return date.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def _joined(lines: Sequence[str]) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode()
