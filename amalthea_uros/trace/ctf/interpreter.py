"""What the interpreters of the events of CTF traces have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from typing import ClassVar, TypeAlias

from amalthea_uros.trace.ctf.streams import CtfEvent
from amalthea_uros.trace.event_rows import EventRows
from amalthea_uros.trace.problems import Problems
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.trace.thread_states import ThreadStates
from amalthea_uros.trace.unique_names import UniqueNames

Handler: TypeAlias = Callable[..., None]


class Interpreter(ABC):
    """Takes events of one origin.

    Attributes
    ----------
    handlers : the methods for the events, by the names of the events
    characteristic : only traces that have one of these events are of this origin
    """

    handlers: ClassVar[dict[str, Handler]] = {}
    characteristic: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, rows: EventRows, states: ThreadStates, problems: Problems, names: UniqueNames) -> None:
        self._rows, self._states, self._problems, self._names = rows, states, problems, names
        self._entities: dict[tuple[EntityKind, str], int] = {}

    @classmethod
    def events(cls, names: Iterable[str]) -> list[str]:
        """Those of some names of events that are understood."""
        known = [name for name in names if name in cls.handlers]
        return known if cls.characteristic.intersection(known) else []

    def add(self, event: CtfEvent) -> None:
        """Take an event."""
        self.handlers[event.name](self, event)

    @abstractmethod
    def finish(self) -> None:
        """Report what is only known at the end."""

    def _thread_of(self, number: object, name: str) -> int:
        """The task of a thread of an operating system with numbers of threads."""
        return self._entity(EntityKind.TASK, self._names.name(("thread", number), name, str(number), "thread"))

    def _core(self, number: object) -> int:
        return self._entity(EntityKind.CORE, f"Core {number if isinstance(number, int) else 0}")

    def _entity(self, kind: EntityKind, name: str) -> int:
        found = self._entities.get((kind, name))
        if found is None:
            found = self._entities[kind, name] = self._rows.index.index(kind, name)
        return found
