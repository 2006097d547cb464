"""Documents as text for a terminal."""

from __future__ import annotations

from amalthea_uros.report.basics.document import Block, Document, Sentences, Table
from amalthea_uros.report.writers.terminal import Terminal


def write_document(document: Document, terminal: Terminal) -> None:
    """Write the opening, the sections, and the outcome."""
    if document.opening:
        terminal.line(document.opening)
    for number, section in enumerate(each for each in document.sections if not each.is_detail):
        if number or document.opening:
            terminal.line()
        terminal.line(terminal.style(section.title, "1"))
        for block in section.blocks:
            write_block(block, terminal)
    if document.closing:
        terminal.heading(document.closing)


def write_block(block: Block, terminal: Terminal) -> None:
    """Write a table, or sentences below it; pictures and what is folded in a page are not for terminals."""
    match block:
        case Table():
            terminal.table([column.title for column in block.columns], block.rows, right=block.right)
        case Sentences(sentences=sentences):
            for sentence in sentences:
                terminal.line(f"  {sentence}")
