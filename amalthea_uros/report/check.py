"""Findings of `amuros check` for people, programs and CI systems."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping
from typing import IO

from amalthea_uros import __version__
from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.fingerprint import fingerprint
from amalthea_uros.findings.grouping import Group
from amalthea_uros.findings.presentation import Presentation
from amalthea_uros.findings.targets import summary
from amalthea_uros.report.findings import finding_json, profile_name
from amalthea_uros.report.github import write_github
from amalthea_uros.report.junit import write_junit
from amalthea_uros.report.sarif import write_sarif
from amalthea_uros.report.terminal import Terminal

#: So many findings of a rule are shown; nobody reads more, and the others are counted.
SHOWN = 100


def write_text(presentation: Presentation, _model: str, stream: IO[str]) -> None:
    """Each flaw with its line; of a rule that fires very often, the first ones."""
    terminal = Terminal(stream)
    count: Counter[str] = Counter()
    for group in presentation.groups:
        shown = group.shown
        count[shown.rule] += 1
        if count[shown.rule] <= SHOWN:
            terminal.findings([shown])
            _write_rest(group, terminal)
    for rule, number in count.items():
        if number > SHOWN:
            terminal.line(f"{rule}: {number - SHOWN} more, not shown; --output json has them all")
    _write_sum(presentation, terminal)


def _write_rest(group: Group, terminal: Terminal) -> None:
    """The other rules that report the same flaw, and how much follows from it."""
    if group.also:
        terminal.line(f"  {terminal.style('also:', '36')} {', '.join(group.also)}")
    if group.consequences:
        count = Counter(finding.rule for finding in group.consequences)
        text = ", ".join(f"{rule} ({number})" for rule, number in count.items())
        terminal.line(f"  {terminal.style('consequences:', '36')} {text}")


def write_statistics(presentation: Presentation, _model: str, stream: IO[str]) -> None:
    """How often each rule fires."""
    terminal = Terminal(stream)
    count = Counter((finding.rule, str(finding.severity)) for finding in presentation.shown)
    if count:
        terminal.table(("rule", "severity", "findings"), [(*key, number) for key, number in count.most_common()], right=(2,))
    _write_sum(presentation, terminal)


def _write_sum(presentation: Presentation, terminal: Terminal) -> None:
    for target, groups in presentation.targets.items():
        terminal.line(summary(target, (group.shown for group in groups)))
    findings = presentation.shown
    by_severity = Counter(finding.severity for finding in findings)
    told = ", ".join(f"{by_severity[severity]} of severity {severity}" for severity in Severity if by_severity[severity])
    number = "1 finding" if len(findings) == 1 else f"{len(findings)} findings"
    terminal.line(f"{number}: {told}" if findings else "no findings")


def write_json(presentation: Presentation, model: str, stream: IO[str]) -> None:
    """All findings, with the profiles of their rules and the findings under which they are shown."""
    findings = [
        {
            **finding_json(finding),
            "profile": profile_name(finding.rule),
            "fingerprint": fingerprint(finding),
            "part_of": part_of,
            "counts": counts,
        }
        for finding, part_of, counts in presentation.entries()
    ]
    content = {"amuros": __version__, "model": model, "assumptions": [], "findings": findings}
    json.dump(content, stream, indent=2, ensure_ascii=False)
    stream.write("\n")


WRITERS: Mapping[str, Callable[[Presentation, str, IO[str]], None]] = {
    "text": write_text,
    "json": write_json,
    "sarif": write_sarif,
    "junit": write_junit,
    "github": write_github,
}
