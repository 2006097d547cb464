"""One event chain for people."""

from __future__ import annotations

from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.report.wording.chains import quantity_text, value_text
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.analyze import ChainDetail


def write(detail: ChainDetail, terminal: Terminal) -> None:
    """Write all values of a chain, and how its events are connected."""
    chain = detail.chain
    terminal.line(f"{terminal.style(chain.name, '1')}, communication {chain.communication}")
    for route in chain.routes:
        terminal.line(f"  {route}")
    for sentence in filter(None, (chain.why, chain.reason)):
        terminal.line(f"  {sentence}")
    values = chain.all_values if detail.all_methods else chain.values
    if values:
        ordered = sorted(values, key=lambda value: list(LatencyQuantity).index(value.quantity))
        rows = [
            (quantity_text(value.quantity), value_text(value), value.claim, f"{value.method} ({value.source})")
            for value in ordered
        ]
        terminal.table(("quantity", "value", "claim", "method"), rows, right=(1,))
