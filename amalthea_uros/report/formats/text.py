"""Text for people: documents, or what a module in `report/text` writes with its function `write`.

Where `write_closing` is beside it, that is what remains for somebody who wants no more than the outcome.
"""

from __future__ import annotations

from typing import IO

from amalthea_uros.report.basics.display import is_brief
from amalthea_uros.report.by_result import module_for, rendered_in
from amalthea_uros.report.documents import DOCUMENTS, document_of
from amalthea_uros.report.writers.terminal import Terminal

RENDERS = rendered_in("text") | DOCUMENTS.keys() - {"ReportContent"}


def write(result: object, stream: IO[str]) -> None:
    """Write tables and sentences, in colour on a terminal."""
    write_text(result, Terminal(stream), is_closing_only=is_brief(stream))


def write_text(result: object, terminal: Terminal, is_closing_only: bool = False) -> None:
    """Write a result, or only its outcome if it has one."""
    if type(result).__name__ not in DOCUMENTS:
        module = module_for(result, "text")
        (getattr(module, "write_closing", module.write) if is_closing_only else module.write)(result, terminal)
        return
    from amalthea_uros.report.writers.text import write_document

    document = document_of(result)
    if is_closing_only and document.closing:
        terminal.line(document.closing)
    else:
        write_document(document, terminal)
