"""Repairs as changes of a text: those of `check --fix` for models; of descriptions, what a finding suggests."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import takewhile

from lsprotocol import types

from amalthea_uros._internal.files import overlaid
from amalthea_uros.editor.description_fixes import of_description
from amalthea_uros.editor.diagnostics import SOURCE
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.errors import AmurosError
from amalthea_uros.services.fix import fix_files
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import ModelCheck
from amalthea_uros.validate.settings import CheckSettings

FIX_ALL = f"{types.CodeActionKind.SourceFixAll.value}.{SOURCE}"


def quick_fixes(
    document: TextDocument, diagnostics: Sequence[types.Diagnostic], kinds: Sequence[str] | None
) -> list[types.CodeAction]:
    """The repairs of the rules of some diagnostics, one for each rule, and all repairs together.

    Parameters
    ----------
    kinds : the kinds of actions that the editor asks for, also more general ones; all of them if it does not say
    """
    if document.is_description:  # only its author knows what is meant, so that nothing is repaired unasked
        return [action for action in of_description(document, diagnostics) if _is_wanted(str(action.kind), kinds)]
    with overlaid(document.contents):
        return [action for action in _actions(document, diagnostics) if _is_wanted(str(action.kind), kinds)]


def _actions(document: TextDocument, diagnostics: Sequence[types.Diagnostic]) -> Iterator[types.CodeAction]:
    for rule in dict.fromkeys(str(found.code) for found in diagnostics if found.source == SOURCE):
        if _is_repairable(rule) and (edit := _edit(document, CheckSettings(select=(rule,)))) is not None:
            yield types.CodeAction(
                title=f"Repair all findings {rule}",
                kind=types.CodeActionKind.QuickFix,
                diagnostics=[found for found in diagnostics if found.code == rule],
                edit=edit,
            )
    if (edit := _edit(document, CheckSettings())) is not None:
        yield types.CodeAction(title="Repair all that amuros can repair", kind=FIX_ALL, edit=edit)


def _is_wanted(kind: str, kinds: Sequence[str] | None) -> bool:
    return not kinds or any(kind == wanted or kind.startswith(f"{wanted}.") for wanted in kinds)


def _is_repairable(identifier: str) -> bool:
    rule = registry.check(identifier)
    return isinstance(rule, ModelCheck) and (rule.fix is not None or rule.in_canonical_form)


def _edit(document: TextDocument, settings: CheckSettings) -> types.WorkspaceEdit | None:
    """What `check --fix` would change, None if it is nothing, or if the text cannot be read."""
    try:
        changed = fix_files(document.path, settings, write=False).changed
    except AmurosError:
        return None
    after = next((change.after for change in changed if change.path == document.path), document.text)
    if after == document.text:
        return None
    return types.WorkspaceEdit(changes={document.uri: [_replacement(document, after)]})


def _replacement(document: TextDocument, after: str) -> types.TextEdit:
    """The lines that differ."""
    old, new = document.text.splitlines(keepends=True), after.splitlines(keepends=True)
    start = _common(old, new)
    end = _common(old[start:][::-1], new[start:][::-1])
    first = _position(document, "".join(old[:start]))
    last = _position(document, "".join(old[: len(old) - end]))
    return types.TextEdit(range=types.Range(first, last), new_text="".join(new[start : len(new) - end]))


def _common(one: Sequence[str], other: Sequence[str]) -> int:
    """How many lines both begin with."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))


def _position(document: TextDocument, before: str) -> types.Position:
    """The position after the beginning of the text."""
    lines = TextDocument(document.uri, document.path, before, None).lines
    return document.position(len(lines) - 1, len(lines[-1]))
