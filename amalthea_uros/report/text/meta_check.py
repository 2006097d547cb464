"""A `colcon.meta` compared with an application, for people; its findings are shown where those of all commands are."""

from __future__ import annotations

from amalthea_uros.report.wording.findings import findings_text
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.generate import MetaCheck


def write(result: MetaCheck, terminal: Terminal) -> None:
    """Write the outcome."""
    outcome = (
        findings_text(result.findings)
        if result.findings
        else f"holds for {result.description}, and nothing is larger than needed"
    )
    terminal.line(f"{terminal.style(str(result.path), '1')}: {outcome}")
