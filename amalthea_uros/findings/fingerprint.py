"""The identity of a finding across edits of the file."""

from __future__ import annotations

from hashlib import sha256

from amalthea_uros.diagnostics import Finding


def fingerprint(finding: Finding) -> str:
    """A digest of a finding that does not change when lines move."""
    return sha256(f"{finding.rule}|{finding.object}|{finding.message}".encode(errors="backslashreplace")).hexdigest()[:32]
