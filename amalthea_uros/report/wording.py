"""Numbers of findings in sentences."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Severity


def findings_text(findings: Collection[Finding]) -> str:
    """How many findings there are: "3 findings: 2 warnings, 1 info"."""
    if not findings:
        return "no findings"
    by_severity = Counter(finding.severity for finding in findings)
    listed = ", ".join(_severities(severity, by_severity[severity]) for severity in Severity if by_severity[severity])
    return f"{counted(len(findings), 'finding')}: {listed}"


def _severities(severity: Severity, number: int) -> str:
    return f"{number:,} {severity}" if severity is Severity.INFO else counted(number, severity)
