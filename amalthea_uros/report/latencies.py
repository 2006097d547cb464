"""End-to-end latencies of event chains in tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.analyze.results import ChainResult, Quantity, Value
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.units import time_text

_COLUMNS = {
    "min": Quantity.MIN_FIRST_TO_FIRST,
    "mean": Quantity.MEAN_FIRST_TO_FIRST,
    "max": Quantity.MAX_REDUCED_REACTION_TIME,
    "reaction time": Quantity.MAX_REACTION_TIME,
    "data age": Quantity.MAX_DATA_AGE,
    "reduced data age": Quantity.MAX_REDUCED_DATA_AGE,
}


def write_chains(terminal: Terminal, chains: Sequence[ChainResult]) -> None:
    """Write a row for each chain."""
    if not chains:
        return
    terminal.heading("Event chains (min, mean, max: first to first; others: max)")
    rows = [(chain.name, *cells(chain, _COLUMNS)) for chain in chains]
    terminal.table(("chain", *_COLUMNS, ""), rows, right=range(1, len(_COLUMNS) + 1))


def cells(chain: ChainResult, columns: Iterable[str]) -> tuple[str, ...]:
    """The cells of a chain: its values, and their claims or why they are missing."""
    values = [chain.value(_COLUMNS[column]) for column in columns]
    claims = dict.fromkeys(str(value.claim) for value in values if value is not None)
    return (*map(value_text, values), chain.reason or ", ".join(claims))


def value_text(value: Value | None) -> str:
    """A latency, or a dash."""
    return "-" if value is None or value.value is None else time_text(value.value)
