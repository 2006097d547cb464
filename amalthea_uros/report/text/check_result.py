"""Findings for people."""

from __future__ import annotations

from collections import Counter

from amalthea_uros.report.terminal import Terminal
from amalthea_uros.report.wording import findings_text
from amalthea_uros.services.check import CheckResult

#: At most so many findings of a rule are shown; nobody reads more, and the others are counted.
SHOWN = 100


def write(result: CheckResult, terminal: Terminal) -> None:
    """Write each finding with its line; of a rule that fires very often, the first ones."""
    count: Counter[str] = Counter()
    for finding in result.findings:
        count[finding.rule] += 1
        if count[finding.rule] <= SHOWN:
            terminal.findings([finding])
    for rule, number in count.items():
        if number > SHOWN:
            terminal.line(f"{rule}: {number - SHOWN} more not shown; --output json has all of them")
    terminal.line(findings_text(result.findings))
