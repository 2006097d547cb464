"""Findings as annotations of GitHub's workflows."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import IO, TYPE_CHECKING

from amalthea_uros.diagnostics import Severity
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.wording.findings import relative

if TYPE_CHECKING:
    from amalthea_uros.services.check import CheckResult

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def write(result: CheckResult, stream: IO[str]) -> None:
    """Write a workflow command for each flaw."""
    shown_path = cache(_shown_path)  # Thousands of findings may be in one file.
    for finding in result.presentation.shown:
        place = finding.location
        where = []
        if place is not None:
            where = [f"file={shown_path(place.path)}"]
            where += [f"line={place.line}", f"col={place.column or 1}"] if place.line else []
        properties = ",".join([*where, f"title={_escaped(finding.rule)}"])
        stream.write(f"::{_COMMANDS[finding.severity]} {properties}::{_escaped(finding.message, properties=False)}\n")


def _shown_path(path: Path) -> str:
    return _escaped(relative(path) or str(path))


def _escaped(text: str, properties: bool = True) -> str:
    """Text in the form that workflow commands expect; hidden characters, and so line ends, are shown as escapes."""
    text = visible(text).replace("%", "%25")
    return text.replace(":", "%3A").replace(",", "%2C") if properties else text
