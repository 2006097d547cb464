"""Texts of descriptions, each understood once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from amalthea_uros.design.changes.change import Change
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.described import Described, describe_text


@lru_cache(maxsize=32)
def described(text: str, path: Path) -> Described:
    """The content of a text, as `describe_text`; searches and edits ask for the same ones again."""
    return describe_text(text, path)


def edited_assembly(text: str, path: Path, changes: Sequence[Change]) -> Assembly:
    """What is built from a text that changes were made in; InvalidArgumentError if it is not valid because of them."""
    try:
        return described(text, path).assembly
    except ReadError as error:
        reasons = "; ".join(finding.message for finding in error.findings if finding.severity is Severity.ERROR)
        what = ", ".join(map(str, changes))
        raise InvalidArgumentError(f"a description with {what} is not valid: {reasons}") from None
