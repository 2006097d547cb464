"""Baselines: files of the findings that were accepted when a project started to check its models."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from amalthea_uros._internal.files import FileError, read_text
from amalthea_uros._internal.limits import BASELINE_SIZE
from amalthea_uros.diagnostics import Finding
from amalthea_uros.findings.fingerprint import fingerprint


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
