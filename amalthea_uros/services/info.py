"""What is in a model."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Finding
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.metamodel.summary import ModelSummary, summarise
from amalthea_uros.services.inputs import as_paths, open_model


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
    """Summarise the model of some files, or of an `app.yaml`.

    Parameters
    ----------
    schema : also validate each file against the XML schema of its version

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    files = as_paths(paths)
    opened = open_model(files)
    model, findings = opened.model, list(opened.findings)
    if schema:
        from amalthea_uros.xmi.schema import schema_findings

        findings += (finding for document in model.documents for finding in schema_findings(document))
    summary = summarise(model)
    if opened.system is not None:
        built = tuple(replace(document, path=str(files[0])) for document in summary.documents)
        summary = replace(summary, documents=built)
    return InfoResult(summary=summary, findings=unsuppressed(findings))
