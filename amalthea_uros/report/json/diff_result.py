"""The differences of two models for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.design.changes.timing_changes import TimingChange
from amalthea_uros.difference.comparison import ModelChange
from amalthea_uros.metamodel.element import Element
from amalthea_uros.report.findings import finding_json
from amalthea_uros.report.json import changes, impact
from amalthea_uros.services.diff import DiffResult


def content(result: DiffResult) -> dict[str, Any]:
    """The changes with their places in the files."""
    found: dict[str, Any] = {
        "old": result.old,
        "new": result.new,
        "timing": [_timing_json(change) for change in result.timing],
        "changes": [change_json(change) for change in result.changes],
        "findings": [finding_json(finding) for finding in result.findings],
    }
    if result.impact is not None:
        found["impact"] = impact.content(result.impact)
    return found


def _timing_json(change: TimingChange) -> dict[str, Any]:
    return {
        "kind": change.happening,
        "class": change.kind,
        "object": change.object,
        "values": changes.content(change.differences),
    }


def change_json(change: ModelChange) -> dict[str, Any]:
    """A difference with its places in the files."""
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
    """The place of an object or its attribute, None if it was not read from a file."""
    document = element.document if element is not None else None
    if element is None or document is None or document.source is None or element not in document.source.index:
        return None
    line, column = document.source.position_of(element, feature)
    return {"file": str(document.path), "line": line, "column": column}
