"""How often each rule fires, for people."""

from __future__ import annotations

from collections import Counter

from amalthea_uros.report.text.check_result import write_sum
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.check import CheckStatistics


def write(statistics: CheckStatistics, terminal: Terminal) -> None:
    """Write a table of the rules, the most frequent first."""
    presentation = statistics.result.presentation
    count = Counter((finding.rule, str(finding.severity)) for finding in presentation.shown)
    if count:
        terminal.table(("rule", "severity", "findings"), [(*key, number) for key, number in count.most_common()], right=(2,))
    write_sum(presentation, terminal)
