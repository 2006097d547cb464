"""What may change: values on offer, and orders of priorities."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import factorial, prod


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
    """

    scheduler: str
    tasks: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Space:
    """All designs that may be proposed: each combination of options, with each order of priorities."""

    choices: tuple[Choice, ...] = ()
    orders: tuple[PriorityOrder, ...] = ()

    @property
    def size(self) -> int:
        """The number of designs, the present one included."""
        return prod(len(choice.options) for choice in self.choices) * prod(factorial(len(each.tasks)) for each in self.orders)
