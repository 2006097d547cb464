"""Documents and tables as parts of a page, such as the output of a cell of a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape

from amalthea_uros.report.basics.document import Block, Line, ResultDocument, Sentences, ShownFinding, Table
from amalthea_uros.report.basics.escape import visible

_TABLE = '<table class="amuros" style="border-collapse:collapse">'
_CELL = "padding:2px 12px 2px 0;vertical-align:top;min-width:4em"


def html_of(document: ResultDocument) -> str:
    """What a terminal shows of a document."""
    return f'<div class="amuros">{"".join(_parts(document))}</div>'


def _parts(document: ResultDocument) -> Iterator[str]:
    yield from map(_line, filter(None, [document.opening]))
    for section in document.sections:
        if not section.is_detail:
            yield from map(_bold, filter(None, [section.title]))
            yield from (part for block in section.blocks for part in _block(block))
    yield from map(_bold, filter(None, [document.closing]))


def _block(block: Block) -> Iterator[str]:
    match block:
        case Table():
            rows = ([str(cell) for cell in row] for row in block.rows)
            yield table_html([column.title for column in block.columns], rows, block.right)
        case Sentences():
            yield from (_line(each, block.indent) for each in block.sentences if str(each).strip())
        case ShownFinding():
            yield _line(str(block.finding))
            yield from (_line(f"{name}: {note}", 2) for name, note in block.notes.items())


def _line(line: Line, indent: int = 0) -> str:
    content = _text(line) if isinstance(line, str) else f"<b>{_text(line.term)}</b>{_text(line.rest)}"
    return f'<div style="white-space:pre-wrap">{" " * indent}{content}</div>'


def _bold(text: str) -> str:
    return f"<p><b>{_text(text)}</b></p>"


def _text(content: str) -> str:
    return escape(visible(content))


def table_html(headings: Sequence[str], rows: Iterable[Sequence[str]], right: Sequence[int]) -> str:
    """A table, with some columns aligned to the right."""

    def row(cells: Sequence[str], tag: str) -> str:
        sides = ("right;white-space:nowrap" if index in right else "left" for index in range(len(cells)))
        made = (
            f'<{tag} style="{_CELL};text-align:{side}">{_text(cell)}</{tag}>' for cell, side in zip(cells, sides, strict=True)
        )
        return f"<tr>{''.join(made)}</tr>"

    body = "".join(row(cells, "td") for cells in rows)
    return f"{_TABLE}<thead>{row(headings, 'th')}</thead><tbody>{body}</tbody></table>"
