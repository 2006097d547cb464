"""Events in time as a table of columns: what a simulation records, and what a trace file contains.

The kinds of events, and the order of those at the same time, are those of the Best Trace Format (BTF 2.3.0); events of chains are
added. Rows are in the order in which the events occur; time never decreases.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import IntEnum, StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass, field, fields
from amalthea_uros.errors import InvalidArgumentError

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray


class EntityKind(StrEnum):
    """What events are about; the values are the type letters of BTF, apart from chains, which BTF does not know."""

    STIMULUS = "STI"
    TASK = "T"
    ISR = "I"
    RUNNABLE = "R"
    LABEL = "SIG"
    SEMAPHORE = "SEM"
    OS_EVENT = "EVENT"
    CORE = "C"
    SCHEDULER = "SCHED"
    CHAIN = "CHAIN"


@dataclass(frozen=True, slots=True)
class Entity:
    """Something that causes events, or that they are about."""

    kind: EntityKind
    name: str


class EventKind(IntEnum):
    """What happens.

    Transitions of tasks and ISRs come first, then those of runnables, accesses to data, semaphores, OS events. The states of counting
    semaphores (from `INCREMENT` on) are in traces of other tools. `CHAIN_STEP` is where
    the effect of an occurrence of a chain's stimulus passes a process: the source is the process, the target the chain, the target
    instance the number of that occurrence, and the note the number of the step, from 0. `GAP` is where a recorder lost events: of its
    source, or of everything if that is no core; the note is their number, if it is known.
    """

    ACTIVATE = 0
    START = 1
    PREEMPT = 2
    RESUME = 3
    TERMINATE = 4
    POLL = 5
    RUN = 6
    PARK = 7
    POLL_PARKING = 8
    RELEASE_PARKING = 9
    WAIT = 10
    RELEASE = 11
    ACTIVATION_LOST = 12
    INTERRUPT_SUSPENDED = 13
    RUNNABLE_START = 20
    RUNNABLE_SUSPEND = 21
    RUNNABLE_RESUME = 22
    RUNNABLE_TERMINATE = 23
    TRIGGER = 30
    READ = 31
    WRITE = 32
    REQUEST_SEMAPHORE = 40
    LOCK = 41
    UNLOCK = 42
    ASSIGNED = 43
    WAITING = 44
    RELEASED = 45
    SET_EVENT = 50
    CLEAR_EVENT = 51
    WAIT_EVENT = 52
    SCHEDULE = 60
    SCHEDULE_POINT = 61
    CHAIN_STEP = 70
    INCREMENT = 80
    DECREMENT = 81
    QUEUED = 82
    USED = 83
    LOCK_USED = 84
    OVERFULL = 85
    FULL = 86
    UNLOCK_FULL = 87
    FREE = 88
    GAP = 90


#: In the column of the note: there is none.
NO_NOTE = -(2**63)


@dataclass(frozen=True, slots=True)
class EventTable:
    """Some events; `source` and `target` are indices into `entities`.

    Attributes
    ----------
    entities : the same for all tables of a trace
    time : picoseconds, int64
    kind : of `EventKind`, int16
    source, target : int32
    source_instance, target_instance : numbers of jobs or occurrences, counted from 0; 0 for what has no instances; int64
    note : a value that belongs to the event, or `NO_NOTE`; of events of OS events the index of the task that owns it; int64
    """

    entities: Sequence[Entity]
    time: Numbers
    kind: NDArray[np.int16]
    source: NDArray[np.int32]
    source_instance: Numbers
    target: NDArray[np.int32]
    target_instance: Numbers
    note: Numbers = field(repr=False)

    @classmethod
    def empty(cls, entities: Sequence[Entity]) -> EventTable:
        """A table without events."""
        columns: list[NDArray[Any]] = [np.empty(0, dtype) for dtype in _DTYPES]
        return cls(entities, *columns)

    def __len__(self) -> int:
        return len(self.time)

    def to_dict(self) -> dict[str, NDArray[Any]]:
        """The columns by their names, as data frames take them."""
        return {name: getattr(self, name) for name in COLUMNS}

    def to_dataframe(self) -> pd.DataFrame:
        """The events with words and names instead of numbers, in the columns of our CSV files (`csv_format`); needs the package pandas.

        Raises
        ------
        ImportError : pandas is not installed; the text says how to install it.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("a data frame needs pandas; install it with: pip install amuros[pandas]") from error
        words = {int(kind): kind.name.lower() for kind in EventKind}
        sources, targets = ([self.entities[number] for number in column.tolist()] for column in (self.source, self.target))
        return pd.DataFrame(
            {
                "time_ps": self.time,
                "event": pd.Categorical([words[kind] for kind in self.kind.tolist()]),
                "source_kind": pd.Categorical([entity.kind.value for entity in sources]),
                "source": pd.Categorical([entity.name for entity in sources]),
                "source_instance": self.source_instance,
                "target_kind": pd.Categorical([entity.kind.value for entity in targets]),
                "target": pd.Categorical([entity.name for entity in targets]),
                "target_instance": self.target_instance,
                "note": pd.Series(self.notes(), dtype=object),
            }
        )

    def notes(self) -> list[int | str | None]:
        """The notes with the names of the owners of OS events; None where there is none."""
        is_owner = np.isin(self.kind, (EventKind.SET_EVENT, EventKind.CLEAR_EVENT, EventKind.WAIT_EVENT))
        return [
            None if note == NO_NOTE else self.entities[note].name if is_name else note
            for note, is_name in zip(self.note.tolist(), is_owner.tolist(), strict=True)
        ]

    def between(self, start: int, end: int) -> EventTable:
        """The events from `start` on and before `end`, in picoseconds; its columns share the memory of this table."""
        first, last = np.searchsorted(self.time, (start, end))
        return self.rows(int(first), int(last))

    def rows(self, first: int, last: int) -> EventTable:
        """The events with these numbers, the last one excluded; its columns share the memory of this table."""
        return self.map_columns(lambda column: column[first:last])

    def where(self, is_kept: Flags) -> EventTable:
        """The events for which a value is true."""
        return self.map_columns(lambda column: column[is_kept])

    def map_columns(self, change: Callable[[NDArray[Any]], NDArray[Any]]) -> EventTable:
        """The table in which each column is what a function makes of it."""
        return EventTable(self.entities, *map(change, self.to_dict().values()))


#: The names of the columns of an `EventTable`, in the order of its fields, and the types of their values.
COLUMNS = tuple(column.name for column in fields(EventTable))[1:]
_DTYPES = (np.int64, np.int16, np.int32, np.int64, np.int32, np.int64, np.int64)


def concatenate(tables: Sequence[EventTable]) -> EventTable:
    """One table of several consecutive ones of the same trace.

    Raises
    ------
    InvalidArgumentError : there are no tables.
    """
    if not tables:
        raise InvalidArgumentError("there are no tables to concatenate; a trace without events is an empty table")
    columns = zip(*(table.to_dict().values() for table in tables), strict=True)
    return EventTable(tables[-1].entities, *map(np.concatenate, columns))
