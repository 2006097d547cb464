"""Findings as SARIF 2.1.0 (OASIS, Static Analysis Results Interchange Format), for code scanning."""

from __future__ import annotations

import json
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any
from urllib.parse import quote

from amalthea_uros._version import __version__
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.report.findings import relative
from amalthea_uros.validate import registry
from amalthea_uros.validate.suppress import fingerprint

if TYPE_CHECKING:
    from amalthea_uros.services.check import CheckResult

RENDERS = ("CheckResult",)

_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}

#: The base of relative paths; viewers replace it by the root of the repository.
_ROOT = "SRCROOT"


def write(result: CheckResult, stream: IO[str]) -> None:
    """Write one run, with the rules that fired and where."""
    used = sorted({finding.rule for finding in result.findings})
    run = {
        "tool": {"driver": {"name": "amuros", "version": __version__, "rules": [_rule(rule) for rule in used]}},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"uri": Path.cwd().as_uri() + "/"}},
        "results": [_result(finding, used.index(finding.rule)) for finding in result.findings],
    }
    log = {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [run]}
    json.dump(log, stream, indent=2, ensure_ascii=False)
    stream.write("\n")


def _rule(identifier: str) -> dict[str, Any]:
    profile = registry.profile_of(identifier)
    if profile is None:
        return {"id": identifier}
    rule = registry.rule(identifier)
    return {
        "id": rule.id,
        "shortDescription": {"text": rule.title},
        "fullDescription": {"text": rule.rationale},
        "help": {"text": rule.remedy},
        "defaultConfiguration": {"level": _LEVELS[rule.severity]},
        "properties": {"tags": [str(profile)]},
    }


def _result(finding: Finding, index: int) -> dict[str, Any]:
    result: dict[str, Any] = {
        "ruleId": finding.rule,
        "ruleIndex": index,
        "level": _LEVELS[finding.severity],
        "message": {"text": finding.message},
        # A finding that moved to another line is the same finding.
        "partialFingerprints": {"object/v1": fingerprint(finding)},
    }
    if finding.location is not None:
        result["locations"] = [
            {"physicalLocation": _place(finding.location.path, finding.location.line, finding.location.column)}
        ]
    return result


def _place(path: Path, line: int | None, column: int | None) -> dict[str, Any]:
    below = relative(path)
    artifact = {"uri": path.resolve().as_uri()} if below is None else {"uri": quote(below), "uriBaseId": _ROOT}
    place: dict[str, Any] = {"artifactLocation": artifact}
    if line:
        place["region"] = {"startLine": line, "startColumn": column or 1}
    return place
