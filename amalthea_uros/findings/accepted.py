"""Findings that somebody accepted: by a comment in the line, or by a baseline of the time when a project started to check."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

from amalthea_uros._internal.files import FileError, read_text
from amalthea_uros._internal.limits import BASELINE_SIZE
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


def fingerprint(finding: Finding) -> str:
    """A digest of a finding that does not change when lines move."""
    from hashlib import sha256  # loads a large library

    return sha256(f"{finding.rule}|{finding.object}|{finding.message}".encode(errors="backslashreplace")).hexdigest()[:32]


def baseline_text(findings: Iterable[Finding]) -> str:
    """The content of a baseline that accepts some findings."""
    accepted = {fingerprint(finding): f"{finding.rule} {finding.object}".strip() for finding in findings}
    return json.dumps({"amuros-baseline": 1, "accepted": dict(sorted(accepted.items()))}, indent=2, ensure_ascii=False) + "\n"


def read_baseline(path: Path) -> set[str]:
    """The fingerprints of the findings that a baseline accepts.

    Raises
    ------
    ValueError : the file is not a baseline.
    """
    try:
        content = json.loads(read_text(path, BASELINE_SIZE))
    except FileError as error:
        raise ValueError(f"{path}: {error.reason}" + (f". {error.advice}" if error.advice else "")) from None
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path} is not a baseline of amuros: {error}") from None
    accepted = content.get("accepted") if isinstance(content, dict) else None
    if not isinstance(accepted, dict):
        raise ValueError(f"{path} is not a baseline of amuros: it has no table 'accepted'")
    return set(accepted)
