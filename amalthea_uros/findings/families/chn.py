"""Findings of the analysis of event chains."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="CHN001",
        title="event chain that is not evaluated",
        severity=Severity.WARNING,
        rationale="A part or an event is missing, the chain contains itself, or an event does not mark one moment of a job.",
        remedy="Complete the chain; use events with an event type.",
    ),
    FindingKind(
        id="CHN002",
        title="no data flow or trigger between two events of a chain",
        severity=Severity.WARNING,
        rationale="The chain is evaluated as if a variable connected the two events.",
        remedy="Add the access or trigger that connects them, or remove the part from the chain.",
    ),
    FindingKind(
        id="CHN003",
        title="event chain without an upper bound",
        severity=Severity.WARNING,
        rationale="The finding names the reason, for example a task without a response-time bound.",
        remedy="Remove the reason: see the finding of the task or event that it names.",
    ),
    FindingKind(
        id="CHN004",
        title="event that nothing in the model causes",
        severity=Severity.WARNING,
        rationale="The finding names the moment at which the event is assumed to occur.",
        remedy="Model what causes the event.",
    ),
    FindingKind(
        id="CHN005",
        title="part of a chain with another start or end than the chain",
        severity=Severity.WARNING,
        rationale="The start and end of the chain are used; those of the part are ignored.",
        remedy="Let the first part start, and the last part end, with the events of the chain.",
    ),
)
