"""Quick fixes in an `app.yaml`: the words that a finding suggests, and the comment that accepts a finding."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from lsprotocol import types

from amalthea_uros.editor.diagnostics import SOURCE
from amalthea_uros.editor.document import TextDocument

_SUGGESTED = re.compile(r"[Dd]id you mean ('[^']+'(?:(?:, | or )'[^']+')*)\?")
_QUOTED = re.compile(r"'([^']+)'")
_IGNORED = re.compile(r"amuros:\s*ignore\[([^\]]*)\]")


def of_description(document: TextDocument, diagnostics: Sequence[types.Diagnostic]) -> Iterator[types.CodeAction]:
    """The quick fixes for some findings."""
    for diagnostic in diagnostics:
        if diagnostic.source == SOURCE and diagnostic.range.start.line < len(document.lines):
            yield from _replacements(document, diagnostic)
            if diagnostic.severity is not types.DiagnosticSeverity.Error:
                yield _acceptance(document, diagnostic)


def _replacements(document: TextDocument, diagnostic: types.Diagnostic) -> Iterator[types.CodeAction]:
    """A change for each suggested word, where the wrong word is found in the line."""
    suggestion = _SUGGESTED.search(diagnostic.message)
    if suggestion is None:
        return
    where = _wrong_word(document, diagnostic, diagnostic.message[: suggestion.start()])
    if where is None:
        return
    words = _QUOTED.findall(suggestion[1])
    for word in words:
        yield types.CodeAction(
            title=f"Replace by '{word}'",
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[diagnostic],
            is_preferred=len(words) == 1,
            edit=types.WorkspaceEdit(changes={document.uri: [types.TextEdit(where, word)]}),
        )


def _wrong_word(document: TextDocument, diagnostic: types.Diagnostic, message: str) -> types.Range | None:
    """Where the word is that a message quotes: the one at the place of the finding, or else the first one after it."""
    start = diagnostic.range.start
    line, column = document.lines[start.line], document.column(start)
    matches = (re.compile(rf"(?<!\w){re.escape(word)}(?!\w)").search(line, column) for word in _QUOTED.findall(message))
    first = min((match for match in matches if match is not None), key=lambda match: match.start(), default=None)
    if first is None:
        return None
    return types.Range(document.position(start.line, first.start()), document.position(start.line, first.end()))


def _acceptance(document: TextDocument, diagnostic: types.Diagnostic) -> types.CodeAction:
    """The comment after the line, or one more rule in the comment that is there."""
    number = diagnostic.range.start.line
    line = document.lines[number]
    ignored = _IGNORED.search(line)
    if ignored is not None:
        column, text = ignored.end(1), f", {diagnostic.code}"
    else:
        column, text = len(line.rstrip()), f"  # amuros: ignore[{diagnostic.code}]"
    place = document.position(number, column)
    return types.CodeAction(
        title=f"Accept {diagnostic.code} in this line",
        kind=types.CodeActionKind.QuickFix,
        diagnostics=[diagnostic],
        edit=types.WorkspaceEdit(changes={document.uri: [types.TextEdit(types.Range(place, place), text)]}),
    )
