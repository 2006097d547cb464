"""From the rows of a file to tables of events."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from amalthea_uros.trace.entity_index import EntityIndex
from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable
from amalthea_uros.trace.vocabulary import OS_EVENTS, PROCESSES

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: The largest number in a column.
MAX = 2**63 - 1
#: So many lines are read at a time.
BLOCK = 1 << 13

#: What the lines with the same words have in common: kind of event, source, target.
Pattern: TypeAlias = tuple[EventKind, int, int]
#: Time, number of the pattern, source instance, target instance, note, line.
Row: TypeAlias = tuple[int, int, int, int, int, int]
NumberedTable: TypeAlias = "tuple[EventTable, NDArray[np.int64]]"


def numbered_table(rows: Sequence[Row], patterns: Sequence[Pattern], index: EntityIndex, scale: int) -> NumberedTable:
    """The table of some rows, and the number of the line of each.

    Parameters
    ----------
    scale : picoseconds of the unit of time
    """
    time, pattern, source_instance, target_instance, note, line = np.array(rows, np.int64).T.copy()
    kind, source, target = np.array(patterns, np.int32)[pattern].T.copy()
    # Before BTF 2.2, what has no instances has the number -1, and so has the simulation as source of a stimulus.
    target_instance = np.maximum(target_instance, 0)
    source_instance = np.where(source_instance < 0, np.where(source == target, target_instance, 0), source_instance)
    table = EventTable(
        index.entities, time * scale, kind.astype(np.int16), source, source_instance, target, target_instance, note
    )
    return table, line


def note_of(text: str, kind: EventKind, index: EntityIndex, name: str) -> int:
    """The note of an event: a whole number, or of an OS event the index of its owner, whose name that is."""
    if not text:
        return NO_NOTE
    if kind in OS_EVENTS:
        return index.source_index(name, PROCESSES)
    try:
        note = int(text)
    except ValueError:  # values of other types have no place in the table
        return NO_NOTE
    return note if abs(note) <= MAX else NO_NOTE
