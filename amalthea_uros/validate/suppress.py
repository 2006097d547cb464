"""Findings that somebody has seen and accepted: by a comment in the line, or in a baseline of a model that is older than the rules."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

from amalthea_uros.diagnostics import Finding

_COMMENT = re.compile(r"amuros:\s*ignore\[([^\]]*)\]")


def is_ignored(finding: Finding) -> bool:
    """Whether the line of a finding has a comment such as `# amuros: ignore[INC-CO-KIND]`."""
    text = finding.location.text if finding.location is not None else None
    return text is not None and finding.rule in _ignored_in(text)


@lru_cache
def _ignored_in(line: str) -> frozenset[str]:
    return frozenset(name.strip() for comment in _COMMENT.findall(line) for name in comment.split(","))


def fingerprint(finding: Finding) -> str:
    """What a finding is known by: it stays the same when lines move."""
    return sha256(f"{finding.rule}|{finding.object}|{finding.message}".encode()).hexdigest()[:32]


def baseline_text(findings: Iterable[Finding]) -> str:
    """The findings that are accepted, for a file."""
    accepted = {fingerprint(finding): f"{finding.rule} {finding.object}".strip() for finding in findings}
    return json.dumps({"amuros-baseline": 1, "accepted": dict(sorted(accepted.items()))}, indent=2, ensure_ascii=False) + "\n"


def read_baseline(path: Path) -> set[str]:
    """The fingerprints of a baseline.

    Raises
    ------
    ValueError : the file is no baseline.
    """
    try:
        accepted = json.loads(path.read_text(encoding="utf-8"))["accepted"]
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise ValueError(f"{path} is no baseline of amuros: {error}") from None
    return set(accepted)
