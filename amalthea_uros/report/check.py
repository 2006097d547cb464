"""Findings of `amuros check` for people, programs and CI systems."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import IO

from amalthea_uros import __version__
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.report.findings import finding_json, profile_name
from amalthea_uros.report.github import write_github
from amalthea_uros.report.junit import write_junit
from amalthea_uros.report.sarif import write_sarif
from amalthea_uros.report.terminal import Terminal

#: So many findings of a rule are shown; nobody reads more, and the others are counted.
SHOWN = 100


def write_text(findings: Sequence[Finding], _model: str, stream: IO[str]) -> None:
    """Each finding with its line; of a rule that fires very often, the first ones."""
    terminal = Terminal(stream)
    count: Counter[str] = Counter()
    for finding in findings:
        count[finding.rule] += 1
        if count[finding.rule] <= SHOWN:
            terminal.findings([finding])
    for rule, number in count.items():
        if number > SHOWN:
            terminal.line(f"{rule}: {number - SHOWN} more, not shown; --output json has them all")
    _write_sum(findings, terminal)


def write_statistics(findings: Sequence[Finding], _model: str, stream: IO[str]) -> None:
    """How often each rule fires."""
    terminal = Terminal(stream)
    count = Counter((finding.rule, str(finding.severity)) for finding in findings)
    if count:
        terminal.table(("rule", "severity", "findings"), [(*key, number) for key, number in count.most_common()], right=(2,))
    _write_sum(findings, terminal)


def _write_sum(findings: Sequence[Finding], terminal: Terminal) -> None:
    by_severity = Counter(finding.severity for finding in findings)
    told = ", ".join(f"{by_severity[severity]} of severity {severity}" for severity in Severity if by_severity[severity])
    number = "1 finding" if len(findings) == 1 else f"{len(findings)} findings"
    terminal.line(f"{number}: {told}" if findings else "no findings")


def write_json(findings: Sequence[Finding], model: str, stream: IO[str]) -> None:
    """All findings, with the profiles of their rules."""
    told = [{**finding_json(finding), "profile": profile_name(finding.rule)} for finding in findings]
    json.dump(
        {"amuros": __version__, "model": model, "assumptions": [], "findings": told}, stream, indent=2, ensure_ascii=False
    )
    stream.write("\n")


WRITERS: Mapping[str, Callable[[Sequence[Finding], str, IO[str]], None]] = {
    "text": write_text,
    "json": write_json,
    "sarif": write_sarif,
    "junit": write_junit,
    "github": write_github,
}
