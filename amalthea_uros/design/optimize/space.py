"""What may change: values on offer, and orders of priorities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import factorial, prod

from amalthea_uros.design.changes.change import Change


class Kind(StrEnum):
    """What kind of decision something is."""

    PERIOD = "period"
    OFFSET = "offset"
    PRIORITY = "priority"
    CORE = "core"
    ORDER = "order"
    PLACEMENT = "placement"
    COMMUNICATION = "communication"
    MEMORY = "memory"
    CLOCK = "clock"
    OTHER = "other"


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """One value out of several.

    Attributes
    ----------
    object, key : what is changed, as for `Change`
    options : the values as text, that of the present design first
    """

    object: str
    key: str
    kind: Kind
    options: tuple[str, ...]

    @property
    def target(self) -> str:
        """The object and the key, such as "Executor_Task.period"."""
        return f"{self.object}.{self.key}"


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorityOrder:
    """Distinct priorities for the tasks of a scheduler, in any order.

    Attributes
    ----------
    tasks : whose priorities may change, in the present order, the most important first
    numbers : the priorities that they share out, the highest first; as many as there are tasks
    """

    scheduler: str
    tasks: tuple[str, ...]
    numbers: tuple[int, ...]

    def changes(self, tasks: Sequence[str]) -> tuple[Change, ...]:
        """The priorities of an order of the tasks, the most important first."""
        return tuple(Change(task, "priority", str(number)) for task, number in zip(tasks, self.numbers, strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class Space:
    """All designs that may be proposed: each combination of options, with each order of priorities."""

    choices: tuple[Choice, ...] = ()
    orders: tuple[PriorityOrder, ...] = ()

    @property
    def size(self) -> int:
        """The number of designs, the present one included."""
        return prod(len(choice.options) for choice in self.choices) * prod(factorial(len(each.tasks)) for each in self.orders)
