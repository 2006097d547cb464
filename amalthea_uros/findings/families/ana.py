"""Findings of the response-time analysis."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="ANA001",
        title="scheduler without a policy",
        severity=Severity.WARNING,
        rationale="Fixed-priority preemptive scheduling is assumed.",
        remedy="Give the scheduler a definition that states its policy.",
    ),
    FindingKind(
        id="ANA002",
        title="scheduling that cannot be analysed",
        severity=Severity.WARNING,
        rationale=(
            "There is no analysis for the policy, the hierarchy of schedulers, or a task on several cores. The "
            "response times of the tasks concerned are unknown."
        ),
        remedy="Use a supported policy, and give each task one core.",
    ),
    FindingKind(
        id="ANA003",
        title="semaphore without a supported protocol",
        severity=Severity.WARNING,
        rationale=(
            "The semaphore has no priority ceiling, or several cores or servers use it. It is analysed as if it "
            "had a priority ceiling on one core."
        ),
        remedy="Use a priority ceiling protocol, and use the semaphore on one core only.",
    ),
    FindingKind(
        id="ANA004",
        title="process with unknown execution demand",
        severity=Severity.WARNING,
        rationale=(
            "A loop, waiting for events, ticks without bounds or a core without a clock frequency make the "
            "demand unbounded, so the response times of this core are unknown."
        ),
        remedy="Give bounds for the ticks and loops, and the frequency of the core.",
    ),
    FindingKind(
        id="ANA005",
        title="process with an unknown activation pattern",
        severity=Severity.WARNING,
        rationale=(
            "The process has no stimulus, or none that bounds its activations, so the response times of this core are unknown."
        ),
        remedy="Give the process a stimulus with a minimum time between two activations.",
    ),
    FindingKind(
        id="ANA006",
        title="overhead that is not taken into account",
        severity=Severity.WARNING,
        rationale=(
            "The cost of this service of the operating system, or of a scheduler that runs on another core, is "
            "missing in the results."
        ),
        remedy="Add the cost to the execution times of the processes that use the service.",
    ),
    FindingKind(
        id="ANA007",
        title="activations that can be lost",
        severity=Severity.WARNING,
        rationale="More jobs can be pending than the activation limit allows. Lost activations are not part of the bounds.",
        remedy="Raise the activation limit, or activate the task less often.",
    ),
    FindingKind(
        id="ANA008",
        title="memory access of unknown cost",
        severity=Severity.WARNING,
        rationale=(
            "The label is not mapped to a memory, or the core has no access element for the memory. The access "
            "is assumed to take no time."
        ),
        remedy="Map the label to a memory, and give the core an access element for it.",
    ),
    FindingKind(
        id="ANA009",
        title="requirement that is not evaluated",
        severity=Severity.WARNING,
        rationale="Only limits of times are evaluated.",
        remedy="State the requirement as a limit of a time, or verify it in another way.",
    ),
)
