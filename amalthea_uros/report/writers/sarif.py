"""Findings as SARIF 2.1.0 (OASIS, Static Analysis Results Interchange Format), for code scanning."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any
from urllib.parse import quote

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros._internal.files import resolved
from amalthea_uros._version import __version__
from amalthea_uros.diagnostics import Severity
from amalthea_uros.report.basics.json_text import write_json
from amalthea_uros.report.wording.findings import profile_name, relative

if TYPE_CHECKING:
    from amalthea_uros.findings.presentation import FindingEntry
    from amalthea_uros.services.check import CheckResult

_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}

#: The base of relative paths; viewers replace it by the root of the repository.
_ROOT = "SRCROOT"


def write(result: CheckResult, stream: IO[str]) -> None:
    """Write one run, with the rules that fired and where."""
    entries = result.presentation.entries(details=result.with_details)
    used = sorted({entry.finding.rule for entry in entries})
    artifact = cache(_artifact)  # Thousands of findings may be in one file.
    driver = {"name": "amuros", "version": __version__, "informationUri": DOCUMENTATION}
    run = {
        "tool": {"driver": {**driver, "rules": [_rule(rule) for rule in used]}},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"uri": Path.cwd().as_uri() + "/"}},
        "results": [_result(entry, used.index(entry.finding.rule), artifact) for entry in entries],
    }
    log = {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [run]}
    write_json(log, stream)


def _rule(identifier: str) -> dict[str, Any]:
    from amalthea_uros.validate import registry

    kind = registry.kind(identifier)
    if kind is None:
        return {"id": identifier}
    url = registry.rule_url(identifier)
    return {
        "id": kind.id,
        "shortDescription": {"text": kind.title},
        "fullDescription": {"text": kind.rationale},
        "help": {"text": f"{kind.remedy} `amuros explain {identifier}` shows more."},
        **({} if url is None else {"helpUri": url}),
        "defaultConfiguration": {"level": _LEVELS[kind.severity]},
        "properties": {"tags": [profile_name(identifier)]},
    }


def _result(entry: FindingEntry, index: int, artifact: Callable[[Path], dict[str, str]]) -> dict[str, Any]:
    from amalthea_uros.findings.accepted import fingerprint

    finding = entry.finding
    result: dict[str, Any] = {
        "ruleId": finding.rule,
        "ruleIndex": index,
        # Viewers and CI systems fail at levels; a tool that nobody asked for is no reason to.
        "level": _LEVELS[finding.severity if entry.counts else Severity.INFO],
        "message": {"text": finding.message},
        # A finding that moved to another line is the same finding.
        "partialFingerprints": {"object/v1": fingerprint(finding)},
    }
    if properties := {"partOf": entry.part_of} if entry.part_of is not None else {}:
        result["properties"] = properties
    if finding.effect is not None:
        result.setdefault("properties", {})["effect"] = finding.effect
    if finding.location is not None:
        place: dict[str, Any] = {"artifactLocation": artifact(finding.location.path)}
        if finding.location.line:
            place["region"] = {"startLine": finding.location.line, "startColumn": finding.location.column or 1}
        result["locations"] = [{"physicalLocation": place}]
    return result


def _artifact(path: Path) -> dict[str, str]:
    below = relative(path)
    return {"uri": resolved(path).as_uri()} if below is None else {"uri": quote(os.fsencode(below)), "uriBaseId": _ROOT}
