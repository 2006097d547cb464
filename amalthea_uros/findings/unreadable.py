"""Whether input could be read at all, which the exit codes of all commands tell from mistakes in what was read."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.diagnostics import Finding

#: What the ids of findings about the content of a readable description start with; `YML00` is for texts that are no YAML.
_CONTENT = ("YML01", "APP", "UR1")


def is_unreadable(findings: Iterable[Finding]) -> bool:
    """Whether one of the findings that ended the reading is about more than the content of a description."""
    return any(not finding.rule.startswith(_CONTENT) for finding in findings)
