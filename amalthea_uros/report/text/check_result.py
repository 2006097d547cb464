"""Findings for people."""

from __future__ import annotations

from collections import Counter

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.grouping import FindingGroup
from amalthea_uros.findings.presentation import Presentation
from amalthea_uros.findings.targets import summary
from amalthea_uros.report.wording.findings import findings_text
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.check import CheckResult

#: At most so many findings of a rule are shown; nobody reads more, and the others are counted.
SHOWN = 100


def write(result: CheckResult, terminal: Terminal) -> None:
    """Write each flaw with its line; of a rule that fires very often, the first ones."""
    count: Counter[str] = Counter()
    for group in result.presentation.groups:
        shown = group.shown
        count[shown.rule] += 1
        if count[shown.rule] <= SHOWN:
            terminal.findings([shown])
            _write_rest(group, terminal)
    for rule, number in count.items():
        if number > SHOWN:
            terminal.line(f"{rule}: {number - SHOWN} more not shown; --output json has all of them")
    write_sum(result.presentation, terminal)


def write_closing(result: CheckResult, terminal: Terminal) -> None:
    """Write the errors, and the number of all findings."""
    errors = [group.shown for group in result.presentation.groups if group.shown.severity is Severity.ERROR]
    terminal.findings(errors[:SHOWN])
    if len(errors) > SHOWN:
        terminal.line(f"{len(errors) - SHOWN} more errors not shown; --output json has all of them")
    terminal.line(findings_text(result.presentation.shown))


def _write_rest(group: FindingGroup, terminal: Terminal) -> None:
    """The other rules that report the same flaw, and how much follows from it."""
    if group.also:
        terminal.line(f"  {terminal.style('also:', '36')} {', '.join(group.also)}")
    if group.consequences:
        count = Counter(finding.rule for finding in group.consequences)
        text = ", ".join(f"{rule} ({number})" for rule, number in count.items())
        terminal.line(f"  {terminal.style('consequences:', '36')} {text}")


def write_sum(presentation: Presentation, terminal: Terminal) -> None:
    """Write a line for each target tool that nobody asked for, and the number of flaws."""
    for target, groups in presentation.targets.items():
        terminal.line(summary(target, (group.shown for group in groups)))
    terminal.line(findings_text(presentation.shown))
