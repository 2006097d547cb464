"""Findings of `amuros check` for people, programs and CI systems."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import IO, Any
from xml.etree import ElementTree

from amalthea_uros import __version__
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.report.findings import finding_json
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.validate import registry
from amalthea_uros.validate.suppress import fingerprint

_SARIF_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}
_GITHUB = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def write_text(findings: Sequence[Finding], statistics: bool, stream: IO[str]) -> None:
    """Each finding with its line, or how often each rule fires."""
    terminal = Terminal(stream)
    if statistics:
        count = Counter((finding.rule, str(finding.severity)) for finding in findings)
        if count:
            terminal.table(
                ("rule", "severity", "findings"), [(*key, number) for key, number in count.most_common()], right=(2,)
            )
    else:
        terminal.findings(findings)
    by_severity = Counter(finding.severity for finding in findings)
    told = ", ".join(f"{by_severity[severity]} of severity {severity}" for severity in Severity if by_severity[severity])
    number = "1 finding" if len(findings) == 1 else f"{len(findings)} findings"
    terminal.line(f"{number}: {told}" if findings else "no findings")


def write_json(findings: Sequence[Finding], statistics: bool, stream: IO[str]) -> None:
    """All findings, with the profiles of their rules."""
    result = {"amuros": __version__, "findings": [{**finding_json(f), "profile": _profile(f.rule)} for f in findings]}
    json.dump(result, stream, indent=2, ensure_ascii=False)
    stream.write("\n")


def _profile(identifier: str) -> str:
    try:
        return str(registry.rule(identifier).profile)
    except KeyError:
        return "reading"


def write_sarif(findings: Sequence[Finding], statistics: bool, stream: IO[str]) -> None:
    """SARIF 2.1.0 (OASIS), for code scanning."""
    used = sorted({finding.rule for finding in findings})
    log = {
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [
            {
                "tool": {"driver": {"name": "amuros", "version": __version__, "rules": [_sarif_rule(rule) for rule in used]}},
                "columnKind": "unicodeCodePoints",
                "results": [_sarif_result(finding, used.index(finding.rule)) for finding in findings],
            }
        ],
    }
    json.dump(log, stream, indent=2, ensure_ascii=False)
    stream.write("\n")


def _sarif_rule(identifier: str) -> dict[str, Any]:
    try:
        rule = registry.rule(identifier)
    except KeyError:
        return {"id": identifier}
    return {
        "id": rule.id,
        "shortDescription": {"text": rule.title},
        "fullDescription": {"text": rule.rationale},
        "help": {"text": rule.remedy},
        "defaultConfiguration": {"level": _SARIF_LEVELS[rule.severity]},
        "properties": {"tags": [str(rule.profile)]},
    }


def _sarif_result(finding: Finding, index: int) -> dict[str, Any]:
    result: dict[str, Any] = {
        "ruleId": finding.rule,
        "ruleIndex": index,
        "level": _SARIF_LEVELS[finding.severity],
        "message": {"text": finding.message},
        # The same finding in another line is the same finding.
        "partialFingerprints": {"object/v1": fingerprint(finding)},
    }
    if finding.location is not None:
        place: dict[str, Any] = {"artifactLocation": {"uri": _relative(finding.location.path)}}
        if finding.location.line:
            place["region"] = {"startLine": finding.location.line, "startColumn": finding.location.column or 1}
        result["locations"] = [{"physicalLocation": place}]
    return result


def _relative(path: Path) -> str:
    """A path from the current folder, where it is below that."""
    try:
        return path.resolve().relative_to(Path.cwd()).as_posix()
    except ValueError:
        return path.resolve().as_uri()


def write_junit(findings: Sequence[Finding], statistics: bool, stream: IO[str]) -> None:
    """A test case for each rule that fired, as CI systems read them."""
    by_rule: dict[str, list[Finding]] = {}
    for finding in findings:
        by_rule.setdefault(finding.rule, []).append(finding)
    failing = {rule for rule, found in by_rule.items() if any(f.severity is not Severity.INFO for f in found)}
    suite = ElementTree.Element("testsuite", name="amuros check", tests=str(max(1, len(by_rule))), failures=str(len(failing)))
    for rule, found in by_rule.items() or {"no findings": []}.items():
        case = ElementTree.SubElement(suite, "testcase", classname=f"amuros.{_profile(rule)}", name=rule)
        if rule in failing:
            failure = ElementTree.SubElement(case, "failure", message=f"{len(found)} findings", type=str(found[0].severity))
            failure.text = "\n".join(map(str, found))
    suites = ElementTree.Element("testsuites")
    suites.append(suite)
    stream.write('<?xml version="1.0" encoding="UTF-8"?>\n')
    stream.write(ElementTree.tostring(suites, encoding="unicode") + "\n")


def write_github(findings: Sequence[Finding], statistics: bool, stream: IO[str]) -> None:
    """Annotations of GitHub's workflows."""
    for finding in findings:
        place = finding.location
        where = []
        if place is not None:
            where = [f"file={_escaped(_relative(place.path))}"]
            where += [f"line={place.line}", f"col={place.column or 1}"] if place.line else []
        properties = ",".join([*where, f"title={_escaped(finding.rule)}"])
        stream.write(f"::{_GITHUB[finding.severity]} {properties}::{_escaped(finding.message, properties=False)}\n")


def _escaped(text: str, properties: bool = True) -> str:
    """Text as workflow commands take it."""
    text = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return text.replace(":", "%3A").replace(",", "%2C") if properties else text


WRITERS: Mapping[str, Callable[[Sequence[Finding], bool, IO[str]], None]] = {
    "text": write_text,
    "json": write_json,
    "sarif": write_sarif,
    "junit": write_junit,
    "github": write_github,
}
