"""Violations of the XML schema as findings."""

from __future__ import annotations

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.metamodel.model import Document
from amalthea_uros.xmi.schema import NoSchemaError, validate


def schema_findings(document: Document) -> list[Finding]:
    """The violations of the XML schema of its version in a file; none if the document has no file."""
    source, path = document.source, document.path
    if source is None or path is None:
        return []
    try:
        # The file of a model that was migrated in memory still has its old version.
        problems = validate(source.text.encode(), document.file_version)
    except NoSchemaError as error:
        return [Finding("XSD000", Severity.WARNING, str(error), Location(path))]
    return [
        Finding(
            "XSD001",
            Severity.ERROR,
            problem.reason,
            Location(path, problem.line, problem.column, source.line(problem.line)),
            problem.advice or "",
            problem.path,
        )
        for problem in problems
    ]
