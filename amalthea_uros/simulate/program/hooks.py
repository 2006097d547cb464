"""What chains and event stimuli add to the programs of processes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TypeAlias

from amalthea_uros.simulate.program.code import Argument

#: An operation that is added to a program, with its arguments.
Operation: TypeAlias = tuple[int, Argument, Argument]


@dataclass(slots=True)
class Hooks:
    """What is added to the program of a process: at its start and end, and before and after its activities, by their numbers."""

    start: list[Operation] = field(default_factory=list)
    end: list[Operation] = field(default_factory=list)
    before: dict[int, list[Operation]] = field(default_factory=dict)
    after: dict[int, list[Operation]] = field(default_factory=dict)

    def all(self) -> Iterator[Operation]:
        """All of them."""
        for operations in (self.start, *self.before.values(), *self.after.values(), self.end):
            yield from operations
