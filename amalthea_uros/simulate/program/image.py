"""The memory of the kernel while it is built, and the programs in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.simulate.kernel.layout import HEAD, OPERATION_SIZE


@dataclass(slots=True)
class Image:
    """Records and lists, one after the other; the head comes first."""

    words: list[int] = field(default_factory=lambda: [0] * HEAD)

    def record(self, size: int, fields: Mapping[int, int] | None = None) -> int:
        """A new record of zeros, apart from some fields; the place at which it begins."""
        place = len(self.words)
        self.words += [0] * size
        self.put(place, fields or {})
        return place

    def put(self, record: int, fields: Mapping[int, int]) -> None:
        """Set fields of a record."""
        for number, value in fields.items():
            self.words[record + number] = value

    def items(self, values: Iterable[int]) -> tuple[int, int]:
        """A new list; the places at which it begins and ends."""
        place = len(self.words)
        self.words += values
        return place, len(self.words)


# Programs: operations whose arguments can be places of other operations that are not known yet.


@dataclass(slots=True, eq=False)
class JumpLabel:
    """A place in a program."""

    number: int = -1


Argument: TypeAlias = int | JumpLabel


@dataclass(slots=True, eq=False)
class JumpTable:
    """Places in a program, as a list in memory."""

    labels: list[JumpLabel]
    place: int


@dataclass(slots=True)
class Code:
    """The program of a process."""

    operations: list[tuple[int, Argument, Argument]] = field(default_factory=list)
    tables: list[JumpTable] = field(default_factory=list)

    def add(self, operation: int, first: Argument = 0, second: Argument = 0) -> None:
        """Append an operation."""
        self.operations.append((operation, first, second))

    def mark(self, label: JumpLabel) -> None:
        """Have a label mean the next operation."""
        label.number = len(self.operations)

    def here(self) -> JumpLabel:
        """A label of the next operation."""
        return JumpLabel(len(self.operations))

    def write(self, image: Image) -> int:
        """Put the program into memory; the place of its first operation."""
        entry = len(image.words)
        places = [entry + number * OPERATION_SIZE for number in range(len(self.operations) + 1)]

        def resolved(argument: Argument) -> int:
            return places[argument.number] if isinstance(argument, JumpLabel) else argument

        for operation, first, second in self.operations:
            image.words += (operation, resolved(first), resolved(second))
        for table in self.tables:
            for index, label in enumerate(table.labels):
                image.words[table.place + index] = places[label.number]
        return entry


# What chains and event stimuli add to the programs of processes.

#: An operation that is added to a program, with its arguments.
Operation: TypeAlias = tuple[int, Argument, Argument]


@dataclass(slots=True)
class ProgramHooks:
    """What is added to the program of a process: at its start and end, and before and after its activities, by their numbers."""

    start: list[Operation] = field(default_factory=list)
    end: list[Operation] = field(default_factory=list)
    before: dict[int, list[Operation]] = field(default_factory=dict)
    after: dict[int, list[Operation]] = field(default_factory=dict)

    def all(self) -> Iterator[Operation]:
        """All of them."""
        for operations in (self.start, *self.before.values(), *self.after.values(), self.end):
            yield from operations
