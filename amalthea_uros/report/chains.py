"""Event chains for people and for programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import IO, Any

from amalthea_uros.analyze.results import Analysis, ChainResult, Quantity, Value
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.timing.dataflow.paths import Path
from amalthea_uros.units import time_text

_COLUMNS = {
    "min": Quantity.MIN_FIRST_TO_FIRST,
    "mean": Quantity.MEAN_FIRST_TO_FIRST,
    "max": Quantity.MAX_REDUCED_REACTION_TIME,
    "reaction": Quantity.MAX_REACTION_TIME,
    "data age": Quantity.MAX_DATA_AGE,
    "reduced": Quantity.MAX_REDUCED_DATA_AGE,
}


def write_chains(terminal: Terminal, chains: Sequence[ChainResult]) -> None:
    """A line for each chain."""
    if not chains:
        return
    terminal.heading("Event chains (min, mean, max: first to first)")
    rows = []
    for chain in chains:
        values = [chain.value(quantity) for quantity in _COLUMNS.values()]
        claims = dict.fromkeys(str(value.claim) for value in values if value is not None)
        rows.append((chain.name, *map(_time, values), chain.reason or ", ".join(claims)))
    terminal.table(("chain", *_COLUMNS, ""), rows, right=range(1, len(_COLUMNS) + 1))


def _time(value: Value | None) -> str:
    return "-" if value is None or value.value is None else time_text(value.value)


def write_chain(analysis: Analysis, name: str, all_methods: bool, stream: IO[str]) -> None:
    """All values of a chain, and how its events hang together."""
    terminal = Terminal(stream)
    chain = next(chain for chain in analysis.chains if chain.name == name)
    terminal.line(f"{terminal.style(name, '1')}, communication {chain.communication}")
    for route in chain.routes:
        terminal.line(f"  {route}")
    for sentence in filter(None, (chain.why, chain.reason)):
        terminal.line(f"  {sentence}")
    values = chain.everything if all_methods else chain.values
    if values:
        ordered = sorted(values, key=lambda value: list(Quantity).index(value.quantity))
        rows = [
            (value.quantity.replace("_", " "), _time(value), value.claim, f"{value.method} ({value.source})")
            for value in ordered
        ]
        terminal.table(("quantity", "value", "claim", "method"), rows, right=(1,))


def chain_json(chain: ChainResult, all_methods: bool) -> dict[str, Any]:
    """A chain for programs."""
    return {
        "name": chain.name,
        "communication": chain.communication,
        "routes": list(chain.routes),
        "why": chain.why,
        "reason": chain.reason,
        "values": [
            {
                "quantity": value.quantity,
                "value_ps": value.value,
                "claim": value.claim,
                "method": value.method,
                "source": value.source,
            }
            for value in (chain.everything if all_methods else chain.values)
        ],
    }


def write_paths(paths: Sequence[Path], chains: Sequence[ChainResult], stream: IO[str]) -> None:
    """Paths with their numbers and latencies."""
    terminal = Terminal(stream)
    rows = []
    for number, (path, chain) in enumerate(zip(paths, chains, strict=True), start=1):
        first, *others = path.processes
        text = first + "".join(f" -[{', '.join(links)}]-> {process}" for links, process in zip(path.links, others, strict=True))
        values = [chain.value(_COLUMNS[column]) for column in ("min", "max", "data age")]
        claims = dict.fromkeys(str(value.claim) for value in values if value is not None)
        rows.append((number, *map(_time, values), chain.reason or ", ".join(claims), text))
    terminal.table(("", "min", "max", "data age", "", "path"), rows, right=(0, 1, 2, 3))
