"""The difference of two models as text for reviews and as JSON for programs."""

from __future__ import annotations

import json
from collections import Counter
from typing import IO, TYPE_CHECKING, Any

from amalthea_uros import __version__
from amalthea_uros.difference.comparison import Change, ChangeKind
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.report.terminal import Terminal

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from amalthea_uros.metamodel.element import Element

_MARKS = {
    ChangeKind.ADDED: ("+", "32"),
    ChangeKind.REMOVED: ("-", "31"),
    ChangeKind.CHANGED: ("~", "33"),
    ChangeKind.MOVED: ("~", "33"),
}


def write_text(changes: Sequence[Change], stream: IO[str]) -> None:
    """Write changes grouped by object, and how many there are."""
    terminal = Terminal(stream)
    for group in _by_object(changes):
        _write_object(group, terminal)
    if changes:
        terminal.line()
    terminal.line(_summary(changes))


def write_json(changes: Iterable[Change], old: Path, new: Path, stream: IO[str]) -> None:
    """Write changes with their places in the files, for programs."""
    result = {
        "amuros": __version__,
        "old": str(old),
        "new": str(new),
        "changes": [_as_json(change) for change in changes],
    }
    json.dump(result, stream, indent=2, ensure_ascii=False)
    stream.write("\n")


def _by_object(changes: Iterable[Change]) -> Iterable[list[Change]]:
    groups: dict[tuple[Element | None, Element | None], list[Change]] = {}
    for change in changes:
        groups.setdefault((change.old_element, change.new_element), []).append(change)
    return groups.values()


def _write_object(group: list[Change], terminal: Terminal) -> None:
    first = group[0]
    mark, colour = _MARKS[first.kind]
    terminal.line(terminal.style(f"{mark} {first.class_name} {first.qualified_name}", colour) + _remark(first))
    for change in group:
        if change.feature:
            terminal.line(f"    {_sentence(change)}")


def _remark(change: Change) -> str:
    """What an added or removed object is about, if its name does not tell, and how much came or went with it."""
    if change.feature:
        return ""
    element = change.new_element or change.old_element
    assert element is not None
    parts = sum(1 for _ in element.walk()) - 1
    count = f"{parts} part{'s' if parts > 1 else ''}" if parts else ""
    known = ", ".join(filter(None, (change.old, change.new, count)))
    return f" ({known})" if known else ""


def _sentence(change: Change) -> str:
    if change.kind is ChangeKind.MOVED:
        return f"moved: {change.old} -> {change.new}"
    if _is_list(change):
        return f"{change.feature}: {', '.join(filter(None, (change.old, change.new)))}"
    return f"{change.feature}: {change.old} -> {change.new}"


def _is_list(change: Change) -> bool:
    element = change.new_element or change.old_element
    assert element is not None
    return any(feature.many and feature.xml_name == change.feature for feature in features_of(type(element)).values())


def _summary(changes: Sequence[Change]) -> str:
    if not changes:
        return "no differences in meaning"
    counts = Counter(change.kind for change in changes)
    listed = ", ".join(f"{counts[kind]} {kind}" for kind in ChangeKind if counts[kind])
    return f"{len(changes)} difference{'s' if len(changes) > 1 else ''}: {listed}"


def _as_json(change: Change) -> dict[str, Any]:
    return {
        "kind": change.kind,
        "class": change.class_name,
        "object": change.qualified_name,
        "feature": change.feature,
        "old": change.old,
        "new": change.new,
        "old_location": _place(change.old_element, change.feature),
        "new_location": _place(change.new_element, change.feature),
    }


def _place(element: Element | None, feature: str) -> dict[str, Any] | None:
    """Where an object or its attribute stands, None if it was not read from a file."""
    document = element.document if element is not None else None
    if element is None or document is None or document.source is None or element not in document.source.index:
        return None
    line, column = document.source.position_of(element, feature)
    return {"file": str(document.path), "line": line, "column": column}
