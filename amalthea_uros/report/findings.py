"""What several formats say of findings."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from amalthea_uros._internal.files import resolved
from amalthea_uros.diagnostics import Finding


def finding_json(finding: Finding) -> dict[str, Any]:
    """A finding for programs."""
    place = finding.location
    return {
        "rule": finding.rule,
        "severity": finding.severity,
        "message": finding.message,
        "help": finding.help,
        "file": str(place.path) if place else None,
        "line": place.line if place else None,
        "column": place.column if place else None,
        "object": finding.object,
    }


def profile_name(identifier: str) -> str:
    """The profile of a rule; "reading" for problems found while reading files and descriptions."""
    from amalthea_uros.validate import registry

    return registry.profile_of(identifier) or "reading"


def relative(path: Path) -> str | None:
    """A path relative to the current folder, None if it is outside of it."""
    try:
        return resolved(path).relative_to(Path.cwd()).as_posix()
    except ValueError:
        return None


def joined(paths: Iterable[Path]) -> str:
    """Paths as they were given on the command line."""
    return " ".join(map(str, paths))
