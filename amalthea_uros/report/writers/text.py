"""Documents as text for a terminal."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
from typing import IO

from amalthea_uros.report.basics.display import is_brief
from amalthea_uros.report.basics.document import Block, Line, Listing, ResultDocument, Sentences, ShownFinding, Table, Tone
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.documents import document_of
from amalthea_uros.report.writers.terminal import Terminal

_STYLES = {Tone.GOOD: "32", Tone.BAD: "31", Tone.UNKNOWN: "33", Tone.NEUTRAL: "1"}


def write(result: object, stream: IO[str]) -> None:
    """Write tables and sentences, in colour on a terminal; only the outcome for somebody who wants no more than that."""
    document, terminal = document_of(result), Terminal(stream)
    if not is_brief(stream) or not (document.kept or document.closing):
        write_document(document, terminal)
        return
    _write_blocks(document.kept, terminal)
    if document.closing:
        terminal.line(document.closing)


def write_document(document: ResultDocument, terminal: Terminal) -> None:
    """Write the opening, the sections, and the outcome."""
    if document.opening:
        terminal.line(document.opening)
    for number, section in enumerate(each for each in document.sections if not each.is_detail):
        if number or document.opening:
            terminal.line()
        if section.title:
            terminal.line(terminal.style(section.title, "1"))
        _write_blocks(section.blocks, terminal)
    if document.closing:
        terminal.heading(document.closing)


def _write_blocks(blocks: Iterable[Block], terminal: Terminal) -> None:
    """Write tables and sentences; pictures and what is folded in a page are not for terminals."""
    for is_plain, group in groupby(blocks, lambda block: isinstance(block, ShownFinding) and not block.notes):
        if is_plain:
            terminal.findings(block.finding for block in group if isinstance(block, ShownFinding))
        else:
            _write_others(group, terminal)


def _write_others(blocks: Iterable[Block], terminal: Terminal) -> None:
    for block in blocks:
        match block:
            case Table():
                terminal.table([column.title for column in block.columns], block.rows, block.right, block.spare)
            case Sentences():
                for sentence in block.sentences:
                    terminal.line(" " * block.indent + _styled(sentence, terminal))
            case ShownFinding():
                terminal.finding(block.finding)
                for name, note in block.notes.items():
                    terminal.line(f"  {terminal.style(f'{name}:', '36')} {note}")
            case Listing():
                # Its own characters for programs, and escapes of the hidden ones for people.
                for line in block.lines:
                    shown = "\t".join(map(visible, line.split("\t"))) if terminal.stream.isatty() else line
                    terminal.stream.write(shown + "\n")


def _styled(line: Line, terminal: Terminal) -> str:
    return line if isinstance(line, str) else terminal.style(line.term, _STYLES[line.tone]) + line.rest
