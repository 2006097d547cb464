"""What a description can begin with, for people."""

from __future__ import annotations

from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.init import Catalogue, Offered


def write(catalogue: Catalogue, terminal: Terminal) -> None:
    """Write a line for each board and each example."""
    _offers("Boards (--board NAME)", catalogue.boards, terminal)
    terminal.line()
    _offers("Examples (--example NAME)", catalogue.examples, terminal)


def _offers(title: str, offers: tuple[Offered, ...], terminal: Terminal) -> None:
    terminal.line(terminal.style(title, "1"))
    width = max(len(offer.name) for offer in offers)
    for offer in offers:
        terminal.line(f"  {offer.name.ljust(width)}  {offer.summary}")
