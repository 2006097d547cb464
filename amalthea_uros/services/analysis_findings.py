"""The findings about a subject and its analysis as they are shown."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from amalthea_uros.diagnostics import Finding
from amalthea_uros.findings.accepted import unsuppressed

if TYPE_CHECKING:
    from amalthea_uros.analyze.results.analysis import Analysis
    from amalthea_uros.uros.assemble import Assembly


def shown_findings(findings: Iterable[Finding], assembly: Assembly | None, analysis: Analysis) -> tuple[Finding, ...]:
    """Findings about a subject and those of its analysis, without those that comments accept.

    Parameters
    ----------
    assembly : of the system of the analysis; None if no description says how large the memory is
    """
    if assembly is None or not analysis.findings:
        return unsuppressed((*findings, *analysis.findings))
    from amalthea_uros.services.waiting_messages import findings_of

    return unsuppressed((*findings, *findings_of(assembly, analysis)))
