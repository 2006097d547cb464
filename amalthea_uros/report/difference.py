"""A difference of two models for people and for programs."""

from __future__ import annotations

import json
from collections import Counter
from itertools import groupby
from pathlib import Path
from typing import IO

from amalthea_uros import __version__
from amalthea_uros.metamodel.difference import Change, ChangeKind
from amalthea_uros.metamodel.element import Element
from amalthea_uros.report.terminal import Terminal

_MARKS = {
    ChangeKind.ADDED: ("+", "32"),
    ChangeKind.REMOVED: ("-", "31"),
    ChangeKind.CHANGED: ("~", "33"),
    ChangeKind.MOVED: ("~", "33"),
}


def write_text(changes: list[Change], stream: IO[str]) -> None:
    """The changes object by object, and their number."""
    terminal = Terminal(stream)
    for (kind, title), group in groupby(changes, key=lambda c: (_MARKS[c.kind], f"{c.object_class} {c.object_name}")):
        mark, colour = kind
        for position, change in enumerate(group):
            if position == 0 or not change.feature:
                parts = f"  ({change.old or change.new})" if change.kind in (ChangeKind.ADDED, ChangeKind.REMOVED) else ""
                terminal.line(terminal.style(f"{mark} {title}", colour) + (parts if parts.strip(" ()") else ""))
            if change.kind is ChangeKind.MOVED:
                terminal.line(f"    moved: {change.old} -> {change.new}")
            elif change.feature:
                terminal.line(f"    {change.feature}: {change.old or '-'} -> {change.new or '-'}")
    counts = Counter(change.kind.value for change in changes)
    total = ", ".join(f"{number} {kind}" for kind, number in counts.items())
    terminal.line(
        f"{len(changes)} difference{'s' if len(changes) != 1 else ''}: {total}" if changes else "no differences in meaning"
    )


def write_json(changes: list[Change], old: Path, new: Path, stream: IO[str]) -> None:
    """The changes one by one, with their places in the files."""
    found = [
        {
            "kind": change.kind.value,
            "class": change.object_class,
            "object": change.object_name,
            "feature": change.feature,
            "old": change.old,
            "new": change.new,
            "old_location": _location(change.old_element),
            "new_location": _location(change.new_element),
        }
        for change in changes
    ]
    json.dump({"amuros": __version__, "old": str(old), "new": str(new), "changes": found}, stream, indent=2, ensure_ascii=False)
    stream.write("\n")


def _location(element: Element | None) -> str | None:
    document = element.document if element is not None else None
    if element is None or document is None or document.source is None or element not in document.source.index:
        return None
    line, column = document.source.position_of(element)
    return f"{document.path}:{line}:{column}"
