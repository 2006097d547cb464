"""The differences of two models for reviews."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from amalthea_uros._internal.plural import counted
from amalthea_uros.difference.comparison import ChangeKind, ModelChange
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.report.text import impact, timing_changes
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.diff import DiffResult

_MARKS = {
    ChangeKind.ADDED: ("+", "32"),
    ChangeKind.REMOVED: ("-", "31"),
    ChangeKind.CHANGED: ("~", "33"),
    ChangeKind.MOVED: ("~", "33"),
}


def write(result: DiffResult, terminal: Terminal) -> None:
    """Write what changes the timing, all changes grouped by object, and how many there are."""
    timing_changes.write(result.timing, terminal)
    for group in _by_object(result.changes):
        _write_object(group, terminal)
    if result.changes:
        terminal.line()
    write_closing(result, terminal)


def write_closing(result: DiffResult, terminal: Terminal) -> None:
    """Write how many differences there are."""
    terminal.line(_summary(result.changes))
    if result.impact is not None:
        impact.write(result.impact, terminal)


def _by_object(changes: Iterable[ModelChange]) -> Iterable[list[ModelChange]]:
    groups: dict[tuple[Element | None, Element | None], list[ModelChange]] = {}
    for change in changes:
        groups.setdefault((change.old_element, change.new_element), []).append(change)
    return groups.values()


def _write_object(group: list[ModelChange], terminal: Terminal) -> None:
    first = group[0]
    mark, colour = _MARKS[first.kind]
    terminal.line(terminal.style(f"{mark} {first.class_name} {first.qualified_name}", colour) + _remark(first))
    for change in group:
        if change.feature:
            terminal.line(f"    {_sentence(change)}")


def _remark(change: ModelChange) -> str:
    """The content of an added or removed object without a unique name, and the number of its parts."""
    if change.feature:
        return ""
    element = change.new_element or change.old_element
    assert element is not None
    parts = sum(1 for _ in element.walk()) - 1
    count = counted(parts, "part") if parts else ""
    known = ", ".join(filter(None, (change.old, change.new, count)))
    return f" ({known})" if known else ""


def _sentence(change: ModelChange) -> str:
    if change.kind is ChangeKind.MOVED:
        return f"moved: {change.old} -> {change.new}"
    if _is_list(change):
        return f"{change.feature}: {', '.join(filter(None, (change.old, change.new)))}"
    return f"{change.feature}: {change.old} -> {change.new}"


def _is_list(change: ModelChange) -> bool:
    element = change.new_element or change.old_element
    assert element is not None
    return any(feature.many and feature.xml_name == change.feature for feature in features_of(type(element)).values())


def _summary(changes: Sequence[ModelChange]) -> str:
    if not changes:
        return "no differences in meaning"
    counts = Counter(change.kind for change in changes)
    listed = ", ".join(f"{counts[kind]} {kind}" for kind in ChangeKind if counts[kind])
    return f"{counted(len(changes), 'difference')}: {listed}"
