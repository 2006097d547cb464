"""Events that are put between those of a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable


class Inserted(NamedTuple):
    """An event between those of a table.

    Attributes
    ----------
    before : the row of the table before which it belongs
    like : the row that occurs at the same time
    """

    before: int
    like: int
    kind: EventKind
    source: int
    source_instance: int
    target: int
    target_instance: int


def insert(table: EventTable, events: Sequence[Inserted]) -> EventTable:
    """A table with more events; those before the same row stay in their order."""
    if not events:
        return table
    before, like, *columns = np.array(events).T
    values = (table.time[like], *columns, np.full(len(events), NO_NOTE))
    pairs = zip(table.to_dict().values(), values, strict=True)
    return EventTable(table.entities, *(np.insert(column, before, value) for column, value in pairs))
