"""The findings of `check` about a text."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path

from lsprotocol import types

from amalthea_uros._internal.files import overlaid
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.errors import ReadError
from amalthea_uros.findings.grouping import FindingGroup, group
from amalthea_uros.services.check import check_files
from amalthea_uros.validate.registry import rule_url

SOURCE = "amuros"

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.INFO: types.DiagnosticSeverity.Information,
}


def diagnostics_of(document: TextDocument) -> list[types.Diagnostic]:
    """One diagnostic for each flaw, as `amuros check` shows them; none for YAML files of other programs.

    A model of several files is checked as a whole.
    """
    with overlaid(document.contents):
        if not document.is_ours:
            return []
        files = document.files
        try:
            groups = check_files(files).presentation.groups
        except ReadError as error:  # the settings of the project
            groups = group(error.findings)
    others = {file for file in files if file != document.path}
    return [_diagnostic(document, found) for found in groups if not _is_elsewhere(found, others)]


def _is_elsewhere(found: FindingGroup, others: Collection[Path]) -> bool:
    """Whether all findings of a flaw are in other files of the model, of which the editor shows them."""
    places = [finding.location for finding in (*found.same, *found.consequences)]
    return all(place is not None and place.path in others for place in places)


def _diagnostic(document: TextDocument, found: FindingGroup) -> types.Diagnostic:
    finding = found.shown
    url = rule_url(finding.rule)
    return types.Diagnostic(
        range=_range(document, finding.location),
        message=_message(document, finding),
        severity=_SEVERITIES[finding.severity],
        code=finding.rule,
        code_description=None if url is None else types.CodeDescription(url),
        source=SOURCE,
        related_information=list(_related(document, found)) or None,
    )


def _message(document: TextDocument, finding: Finding) -> str:
    """What is wrong and what to do; where, if it is in another file."""
    place = finding.location
    where = f"{place}: " if place is not None and place.path != document.path else ""
    return f"{where}{finding.message}" + (f"\n{finding.help}" if finding.help else "")


def _range(document: TextDocument, place: Location | None) -> types.Range:
    """The word at a place; the start of the text if the place is not in it."""
    if place is None or place.line is None or place.path != document.path:
        return document.token(0, 0)
    return document.token(place.line - 1, (place.column or 1) - 1)


def _related(document: TextDocument, found: FindingGroup) -> Iterator[types.DiagnosticRelatedInformation]:
    """What else is reported because of the same flaw."""
    for finding in (*found.same[1:], *found.consequences):
        place = finding.location
        if place is None:
            continue
        start = types.Position((place.line or 1) - 1, (place.column or 1) - 1)
        is_here = place.path == document.path
        yield types.DiagnosticRelatedInformation(
            location=types.Location(
                uri=document.uri if is_here else place.path.absolute().as_uri(),
                range=_range(document, place) if is_here else types.Range(start, start),
            ),
            message=f"{finding.rule}: {finding.message}",
        )
