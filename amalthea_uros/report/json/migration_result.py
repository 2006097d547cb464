"""What a migration did, for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.report.findings import finding_json
from amalthea_uros.services.migrate import MigrationResult
from amalthea_uros.services.migration import MigrationChange

_KINDS = {"kept as custom property": "kept_as_property"}


def content(result: MigrationResult) -> dict[str, Any]:
    """The files, and every object that was changed."""
    return {
        "model": " ".join(str(file.path) for file in result.files),
        "from": ", ".join(dict.fromkeys(file.version for file in result.files if file.version)),
        "to": result.version,
        "files": [
            {
                "file": str(file.path),
                "version": file.version or None,
                "target": str(file.target) if file.target is not None else None,
                "state": file.state,
            }
            for file in result.files
        ],
        "changes": [_change(change) for change in result.changes],
        "findings": [finding_json(finding) for finding in result.findings],
    }


def _change(change: MigrationChange) -> dict[str, Any]:
    place = change.location
    return {
        "kind": _KINDS.get(change.kind, change.kind.replace(" ", "_")),
        "step": change.step or None,
        "message": change.message,
        "detail": change.detail,
        "object": change.object,
        "file": str(place.path) if place else None,
        "line": place.line if place else None,
        "column": place.column if place else None,
    }
