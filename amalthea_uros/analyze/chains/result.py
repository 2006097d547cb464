"""What is told of a chain."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.chains.quantities import Quantity, Value


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainResult:
    """A chain.

    Attributes
    ----------
    routes : for people: events, and what carries the effect between them
    values : the tightest of each quantity
    everything : those of all methods
    why : why they are exact, or bounds
    reason : why there are no values, or some are missing
    """

    name: str
    communication: str
    routes: tuple[str, ...] = ()
    values: tuple[Value, ...] = ()
    everything: tuple[Value, ...] = ()
    why: str = ""
    reason: str = ""

    def value(self, quantity: Quantity) -> Value | None:
        """The tightest value of a quantity."""
        return next((value for value in self.values if value.quantity is quantity), None)
