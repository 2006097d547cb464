"""Findings as JUnit XML, as CI systems show tests."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Severity, worst
from amalthea_uros.report.basics.escape import output_line, visible
from amalthea_uros.report.wording.findings import joined, profile_name

if TYPE_CHECKING:
    from amalthea_uros.services.check import CheckResult


def write(result: CheckResult, stream: IO[str]) -> None:
    """Write a test case for each rule that was checked or has findings; it fails if one of them is more than information."""
    from xml.etree import ElementTree

    by_rule: dict[str, list[Finding]] = {rule: [] for rule in result.rules}
    entries = result.presentation.entries(details=result.with_details)
    for finding in (entry.finding for entry in entries if entry.counts):
        by_rule.setdefault(finding.rule, []).append(finding)
    failing = {rule for rule, found in by_rule.items() if any(f.severity is not Severity.INFO for f in found)}
    suites = ElementTree.Element("testsuites")
    suite = ElementTree.SubElement(suites, "testsuite", name=visible(f"amuros check {joined(result.paths)}"))
    suite.attrib |= {"tests": str(len(by_rule)), "failures": str(len(failing)), "errors": "0"}
    for rule, found in by_rule.items():
        case = ElementTree.SubElement(suite, "testcase", classname=f"amuros.{profile_name(rule)}", name=rule)
        if rule in failing:
            text = ElementTree.SubElement(case, "failure", message=counted(len(found), "finding"), type=str(worst(found)))
        elif found:
            text = ElementTree.SubElement(case, "system-out")
        else:
            continue
        text.text = "\n".join(output_line(str(finding)) for finding in found)
    stream.write('<?xml version="1.0" encoding="UTF-8"?>\n')
    stream.write(ElementTree.tostring(suites, encoding="unicode") + "\n")
