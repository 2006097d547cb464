"""Programs: operations whose arguments can be places of other operations that are not known yet."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from amalthea_uros.simulate.layout import OPERATION_SIZE
from amalthea_uros.simulate.program.image import Image


@dataclass(slots=True, eq=False)
class Label:
    """A place in a program."""

    number: int = -1


Argument: TypeAlias = int | Label


@dataclass(slots=True, eq=False)
class Table:
    """Places in a program, as a list in memory."""

    labels: list[Label]
    place: int


@dataclass(slots=True)
class Code:
    """The program of a process."""

    operations: list[tuple[int, Argument, Argument]] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)

    def add(self, operation: int, first: Argument = 0, second: Argument = 0) -> None:
        """Append an operation."""
        self.operations.append((operation, first, second))

    def mark(self, label: Label) -> None:
        """Have a label mean the next operation."""
        label.number = len(self.operations)

    def here(self) -> Label:
        """A label of the next operation."""
        return Label(len(self.operations))

    def write(self, image: Image) -> int:
        """Put the program into memory; the place of its first operation."""
        entry = len(image.words)
        places = [entry + number * OPERATION_SIZE for number in range(len(self.operations) + 1)]

        def resolved(argument: Argument) -> int:
            return places[argument.number] if isinstance(argument, Label) else argument

        for operation, first, second in self.operations:
            image.words += (operation, resolved(first), resolved(second))
        for table in self.tables:
            for index, label in enumerate(table.labels):
                image.words[table.place + index] = places[label.number]
        return entry
