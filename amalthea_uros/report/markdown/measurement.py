"""A measurement as Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.measure.series import Measurement
from amalthea_uros.report import measured
from amalthea_uros.report.markdown_text import escaped, table
from amalthea_uros.report.text.measurement import COUNTS, NET, PERIODS


def lines(measurement: Measurement) -> Iterator[str]:
    """The times, what was subtracted, and what could not be used."""
    yield from (f"# Measurement of {escaped(measurement.source)}", "", escaped(measured.closing_line(measurement)), "")
    yield from table(measured.COLUMNS, map(measured.row, measurement.series), right=measured.RIGHT)
    parts = (
        ("Baselines", NET, measured.net_rows(measurement)),
        ("Deviation from the standard period", PERIODS, measured.period_rows(measurement)),
        ("Events that gave no value", COUNTS, measured.count_rows(measurement)),
    )
    for title, columns, rows in parts:
        if found := list(rows):
            yield from ("", f"## {title}", "")
            yield from table(columns, found)
    if measurement.findings:
        yield from ("", "## Findings", "")
        findings = [(each.location or "", each.rule, each.severity, each.message) for each in measurement.findings]
        yield from table(("place", "id", "severity", "message"), findings)
