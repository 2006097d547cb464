"""What is in a model."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from amalthea_uros.diagnostics import Finding
from amalthea_uros.metamodel.summary import ModelSummary, summarise
from amalthea_uros.services.paths import StrPath, as_paths
from amalthea_uros.xmi.load import load


@dataclass(frozen=True, slots=True, kw_only=True)
class InfoResult:
    """The summary of a model.

    Attributes
    ----------
    findings : problems found while reading, and on request by the XML schema
    """

    summary: ModelSummary
    findings: tuple[Finding, ...]


def info(paths: StrPath | Iterable[StrPath], schema: bool = False) -> InfoResult:
    """Summarise the model of some files.

    Parameters
    ----------
    schema : also validate each file against the XML schema of its version

    Raises
    ------
    ReadError : a file cannot be read.
    """
    model = load(*as_paths(paths))
    findings = list(model.findings)
    if schema:
        from amalthea_uros.xmi.schema_findings import schema_findings

        findings += (finding for document in model.documents for finding in schema_findings(document))
    return InfoResult(summary=summarise(model), findings=tuple(findings))
