"""Programs: operations whose arguments can be places of other operations that are not known yet."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from amalthea_uros.simulate.layout import OPERATION_SIZE
from amalthea_uros.simulate.operations import END, ENTER, JUMP, NOTE, POINT, UNMASK
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
    """The program of a process.

    Attributes
    ----------
    returns : the numbers of the operations that let others go first because a call or a non-interruptible group has ended
    """

    operations: list[tuple[int, Argument, Argument]] = field(default_factory=list)
    returns: list[int] = field(default_factory=list)
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

    def drop_last_returns(self) -> None:
        """A job ends at once after its last call or group: then there is nothing that others could go first of."""
        for number in self.returns:
            if self._leads_to_end(number + 1):
                self.operations[number] = (JUMP, Label(number + 1), 0)

    def _leads_to_end(self, number: int) -> bool:
        while True:
            operation, first, _ = self.operations[number]
            if operation == JUMP and isinstance(first, Label):
                number = first.number
            elif operation in (NOTE, UNMASK) or operation >= ENTER or (operation == POINT and number in self.returns):
                number += 1
            else:
                return operation == END

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
