"""Findings of the timing analysis."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="ANA001",
        title="scheduler without a policy",
        severity=Severity.WARNING,
        rationale="The scheduling order is unknown, so the response times of its tasks, and of what they can delay, are unknown.",
        remedy="Reference a scheduler definition with a policy, e.g. FixedPriorityPreemptive.",
    ),
    FindingKind(
        id="ANA002",
        title="scheduling that cannot be analysed",
        severity=Severity.WARNING,
        rationale=(
            "The policy, the hierarchy of schedulers, or a task on several cores is not supported, so the response times "
            "of these tasks, and of the tasks that depend on them, are unknown."
        ),
        remedy="Use a supported policy, and allocate each task to a single core.",
    ),
    FindingKind(
        id="ANA003",
        title="critical sections that cannot be analysed",
        severity=Severity.WARNING,
        rationale=(
            "A process shares a semaphore with other cores or servers, does not release it on every way through its activities, "
            "or can wait for it forever. Its response time is unknown, and so are those of processes that it can delay."
        ),
        remedy="Release each semaphore on every way, use a priority ceiling, and use the semaphore on one core only.",
    ),
    FindingKind(
        id="ANA004",
        title="process with unknown execution demand",
        severity=Severity.WARNING,
        rationale=(
            "Without ticks or execution needs, the demand is not stated; loops, waiting for events or for other processes, "
            "incomplete activities, ticks without bounds, or a core without a clock frequency make it unbounded. The response "
            "times of this process and of lower priorities on its core are unknown."
        ),
        remedy="Complete the activities, set bounds for ticks, avoid loops and waiting, and set the clock frequency of the core.",
    ),
    FindingKind(
        id="ANA005",
        title="process with an unknown activation pattern",
        severity=Severity.WARNING,
        rationale=(
            "The process has no stimulus, or its activations are unbounded, so the response times of this process and of "
            "lower priorities on its core are unknown."
        ),
        remedy="Add a stimulus with a minimum time between two activations.",
    ),
    FindingKind(
        id="ANA006",
        title="overhead that is ignored",
        severity=Severity.WARNING,
        rationale=("The execution time of this operating system service is not included in the results."),
        remedy="Add the overhead to the execution times of the processes that use the service.",
    ),
    FindingKind(
        id="ANA007",
        title="activations that can be lost",
        severity=Severity.WARNING,
        rationale=(
            "More jobs can be pending than the activation limit allows. The bounds do not cover lost activations. If it is "
            "certain that activations are lost, the process fails, and so does the analysis."
        ),
        remedy="Raise the activation limit, or activate the task less often.",
    ),
    FindingKind(
        id="ANA008",
        title="memory access with unknown latency",
        severity=Severity.WARNING,
        rationale=(
            "The label or channel is not mapped to a memory, or the core has no access element for the memory, so the demand "
            "of the processes that access it is unknown."
        ),
        remedy="Map the label to a memory, and give the core an access element for it.",
    ),
    FindingKind(
        id="ANA009",
        title="requirement that is not evaluated",
        severity=Severity.WARNING,
        rationale="Only time limits are evaluated. The verdict on others is unknown.",
        remedy="Use a time limit, or verify the requirement by other means.",
    ),
    FindingKind(
        id="ANA010",
        title="implausible limit",
        severity=Severity.WARNING,
        rationale="A negative limit can never be met, or is always met; one of more than a year is met by everything.",
        remedy="Correct the value or the unit of the limit.",
    ),
)
