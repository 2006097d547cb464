"""What readers of text logs of schedulers have in common."""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Callable, Hashable, Iterator
from pathlib import Path

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.files import TracePlace, opened_text
from amalthea_uros.trace.reading import BLOCK, EventRows, TraceReader
from amalthea_uros.trace.schedulers.thread_states import ThreadStates
from amalthea_uros.trace.table import NO_NOTE, EntityKind, EventTable

_SECOND = 12
_NUMBER = re.compile(r"([+-]?)([0-9]{1,30})(?:\.([0-9]{1,30}))?")
#: Marks in the text of user events, as ftrace has them: B|name and E|name are begin and end of an interval.
_MARK = re.compile(r"([BE])\|(?:[0-9]+\|)?(.*)", re.DOTALL)


class ThreadLogReader(TraceReader):
    """Gives the events of a log of a scheduler."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._rows = EventRows(self._index, self._problems)
        self._states = ThreadStates(self._rows, self._problems)
        self._names = UniqueNames()
        self._place = TracePlace()

    def __iter__(self) -> Iterator[EventTable]:
        """The events, in consecutive tables."""
        with opened_text(self._path, self._problems) as stream:
            for number, line in enumerate(stream, 1):
                text = line.rstrip("\r\n")
                if text and not text.isspace():
                    self._place = TracePlace(number, 1, text)
                    self._read(text)
                if number % BLOCK == 0 and (table := self._states.take()) is not None:
                    yield table
        if (table := self._states.take(is_end=True)) is not None:
            yield table

    @abstractmethod
    def _read(self, text: str) -> None:
        """Read a line that is not empty, which is at `_place`."""

    def _switch_to(self, core: int, name: str, is_idle: bool) -> None:
        """Have a core execute a task from now on, or nothing."""
        if is_idle:
            self._states.switch_out(core)
        else:
            self._states.switch_in(core, self._task(name))

    def _core(self, number: int) -> int:
        return self._index.index(EntityKind.CORE, f"Core {number}")

    def _task(self, name: str) -> int:
        return self._index.index(EntityKind.TASK, name)

    def _interrupt(self, name: str) -> int:
        return self._index.index(EntityKind.ISR, name)

    def _runnable(self, name: str) -> int:
        return self._index.index(EntityKind.RUNNABLE, name)

    def _move_to(self, time: int) -> bool:
        """Whether an event can be at a time; without it, what is open cannot go on."""
        is_in_order = self._rows.move_to(time, self._place)
        if not is_in_order:
            self._states.lose()
        return is_in_order

    def _reject(self, message: str) -> None:
        """Report a line that may have been an event; without it, what is open cannot go on."""
        self._problems.add("TRC002", Severity.ERROR, f"{message}; this line is ignored", self._place)
        self._states.lose()

    def _leave_out(self, message: str) -> None:
        self._problems.add("TRC003", Severity.WARNING, f"{message}; it is ignored", self._place)

    def _lose(self, lost: int = NO_NOTE) -> None:
        """Take a loss of events over that the recorder states."""
        advice = "Record into a larger buffer, or fewer kinds of events."
        self._problems.add("TRC022", Severity.WARNING, "the recorder has lost events", self._place, advice)
        self._states.lose(lost=lost)

    def _mark(self, core: int, text: str) -> None:
        """Take a user event."""
        add_mark(self._states, core, text, self._runnable)


def add_mark(states: ThreadStates, core: int, text: str, runnable_of: Callable[[str], int]) -> None:
    """Take a user event: the begin (B|name) or end (E|name) of an interval, or a moment, which becomes an interval without length.

    Parameters
    ----------
    runnable_of : gives the runnable with a name
    """
    match = _MARK.fullmatch(text.strip())
    name = (match[2] if match else text).strip()
    if match is None:
        states.mark_moment(core, runnable_of(name or "event"))
    elif match[1] == "B":
        states.start_runnable_on(core, runnable_of(name or "interval"))
    else:
        states.end_runnable_on(core, runnable_of(name) if name else None)


def picoseconds(text: str, exponent: int = _SECOND) -> int | None:
    """A decimal number as picoseconds, None if it is not one; what is less than a picosecond is cut off.

    Parameters
    ----------
    exponent : power of ten of picoseconds in its unit
    """
    match = _NUMBER.fullmatch(text)
    if match is None:
        return None
    fraction = (match[3] or "")[:exponent].ljust(exponent, "0")
    value = int(match[2] + fraction)
    return -value if match[1] == "-" else value


# Names of objects that a recorder knows by numbers or addresses: names may be missing, and several objects may have the same one.


class UniqueNames:
    """Gives each object a name of its own.

    The first one with a name keeps it; the identification of the others is added in brackets.
    """

    def __init__(self) -> None:
        self._names: dict[Hashable, str] = {}
        self._owners: dict[str, Hashable] = {}

    def name(self, key: Hashable, name: str, identification: str, missing: str) -> str:
        """The name of an object, which stays the same.

        Parameters
        ----------
        key : what identifies the object
        name : what the recorder calls it, maybe nothing
        identification : the key as text
        missing : what kind of object it is, for its name if it has none
        """
        known = self._names.get(key)
        if known is None:
            wanted = name.strip() or f"{missing} {identification}"
            known = wanted if wanted not in self._owners else f"{wanted} ({identification})"
            number = 2
            while known in self._owners:
                known, number = f"{wanted} ({identification}, {number})", number + 1
            self._names[key] = known
            self._owners[known] = key
        return known
