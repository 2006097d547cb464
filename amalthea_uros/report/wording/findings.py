"""Findings in words: their number, the profiles of their rules, and their files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable
from pathlib import Path

from amalthea_uros._internal.files import resolved
from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Severity


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


def findings_text(findings: Collection[Finding]) -> str:
    """How many findings there are: "3 findings: 2 warnings, 1 info"."""
    if not findings:
        return "no findings"
    by_severity = Counter(finding.severity for finding in findings)
    listed = ", ".join(_severities(severity, by_severity[severity]) for severity in Severity if by_severity[severity])
    return f"{counted(len(findings), 'finding')}: {listed}"


def _severities(severity: Severity, number: int) -> str:
    return f"{number:,} {severity}" if severity is Severity.INFO else counted(number, severity)
