"""Findings that somebody accepted by a comment in the line."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache

from amalthea_uros.diagnostics import Finding

_COMMENT = re.compile(r"amuros:\s*ignore\[([^\]]*)\]")


def is_suppressed(finding: Finding) -> bool:
    """Whether the line of a finding has a comment such as `# amuros: ignore[INC-CO-KIND]`."""
    text = finding.location.text if finding.location is not None else None
    return text is not None and finding.rule in _ignored_in(text)


def unsuppressed(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """The findings that no comment accepts."""
    return tuple(finding for finding in findings if not is_suppressed(finding))


@lru_cache
def _ignored_in(line: str) -> frozenset[str]:
    return frozenset(name.strip() for comment in _COMMENT.findall(line) for name in comment.split(","))
