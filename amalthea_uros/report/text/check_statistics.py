"""How often each rule fires, for people."""

from __future__ import annotations

from collections import Counter

from amalthea_uros.report.terminal import Terminal
from amalthea_uros.report.wording import findings_text
from amalthea_uros.services.check import CheckStatistics


def write(statistics: CheckStatistics, terminal: Terminal) -> None:
    """Write a table of the rules, the most frequent first."""
    findings = statistics.result.findings
    count = Counter((finding.rule, str(finding.severity)) for finding in findings)
    if count:
        terminal.table(("rule", "severity", "findings"), [(*key, number) for key, number in count.most_common()], right=(2,))
    terminal.line(findings_text(findings))
