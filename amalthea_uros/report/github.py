"""Findings as annotations of GitHub's workflows."""

from __future__ import annotations

from typing import IO

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.presentation import Presentation
from amalthea_uros.report.findings import relative

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def write_github(presentation: Presentation, _model: str, stream: IO[str]) -> None:
    """A workflow command for each flaw."""
    for finding in presentation.shown:
        place = finding.location
        where = []
        if place is not None:
            where = [f"file={_escaped(relative(place.path) or str(place.path))}"]
            where += [f"line={place.line}", f"col={place.column or 1}"] if place.line else []
        properties = ",".join([*where, f"title={_escaped(finding.rule)}"])
        stream.write(f"::{_COMMANDS[finding.severity]} {properties}::{_escaped(finding.message, properties=False)}\n")


def _escaped(text: str, properties: bool = True) -> str:
    """Text as workflow commands take it."""
    text = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return text.replace(":", "%3A").replace(",", "%2C") if properties else text
