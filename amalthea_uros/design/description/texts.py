"""Texts of descriptions that changes were made in."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from amalthea_uros.design.changes.change import Change
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.described import describe_text


def edited_assembly(text: str, path: Path, changes: Sequence[Change]) -> Assembly:
    """The system that is built from a text with changes, and how; InvalidArgumentError if it is not valid because of them."""
    try:
        return describe_text(text, path).assembly
    except ReadError as error:
        reasons = "; ".join(finding.message for finding in error.findings if finding.severity is Severity.ERROR)
        what = ", ".join(map(str, changes))
        raise InvalidArgumentError(f"a description with {what} is not valid: {reasons}") from None
