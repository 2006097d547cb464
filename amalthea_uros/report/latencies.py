"""End-to-end latencies of event chains in tables."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity, LatencyValue
from amalthea_uros.units import Rounding, rounded_time_text

#: The headline quantities: `reaction` and `data age` are what the limits of these names are compared with.
COLUMNS = {
    "min": LatencyQuantity.MIN_FIRST_TO_FIRST,
    "mean": LatencyQuantity.MEAN_FIRST_TO_FIRST,
    "reaction": LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    "data age": LatencyQuantity.MAX_REDUCED_DATA_AGE,
}
_NAMES = {quantity: column for column, quantity in COLUMNS.items() if quantity.is_upper}
HEADING = (
    "Event chains (from the stimulus to the first response based on it; data age: from the latest stimulus to each response)"
)


def cells(chain: ChainResult, columns: Iterable[str]) -> tuple[str, ...]:
    """The cells of a chain: its values, and their claims or why they are missing."""
    values = [chain.value(COLUMNS[column]) for column in columns]
    claims = dict.fromkeys(str(value.claim) for value in values if value is not None)
    return (*map(value_text, values), chain.reason or ", ".join(claims))


def value_text(value: LatencyValue | None) -> str:
    """A latency that is still a bound when it has lost digits, or a dash."""
    if value is None or value.value is None:
        return "-"
    return rounded_time_text(value.value, _rounding(value.quantity))


def _rounding(quantity: LatencyQuantity) -> Rounding:
    if quantity.is_mean:
        return Rounding.NEAREST
    return Rounding.UP if quantity.is_upper else Rounding.DOWN


def quantity_text(quantity: LatencyQuantity) -> str:
    """The full name of a quantity, with the short one of the tables and limits if it has one."""
    name = quantity.replace("_", " ")
    return f"{name} ({_NAMES[quantity]})" if quantity in _NAMES else name
