"""Findings of comparisons of predictions with measurements."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="CMP001",
        title="measured value beyond a bound",
        severity=Severity.ERROR,
        rationale=(
            "An analytic bound holds for all that the model describes. What exceeds it is not described: an execution time is longer, "
            "a period shorter, or something else uses the core."
        ),
        remedy="Correct the model, for example with measured times; or state how far measured times may be wrong.",
    ),
    FindingKind(
        id="CMP002",
        title="measured object that the model does not have",
        severity=Severity.WARNING,
        rationale="Objects of a trace and of the model are matched by name. Without one, what was measured is not compared.",
        remedy="Say with --map TRACE_NAME=MODEL_NAME what it is in the model.",
    ),
    FindingKind(
        id="CMP003",
        title="agreeing means of different distributions",
        severity=Severity.WARNING,
        rationale=(
            "The measured mean agrees with the simulated one, but the values are distributed differently: something that happens "
            "sometimes, such as a message to take, has another effect or occurs more or less often than in the model."
        ),
        remedy="Compare the histograms, and describe the cases apart, for example by an execution time per message.",
    ),
    FindingKind(
        id="CMP004",
        title="unknown phase",
        severity=Severity.WARNING,
        rationale=(
            "What comes from outside may have any phase in the measured system. Values that depend on it, such as latencies of chains, "
            "are predicted as ranges: the model agrees if they agree in one of the phases, which is less than could be tested."
        ),
        remedy="State the phase with --phase, if it is known and constant.",
    ),
    FindingKind(
        id="CMP005",
        title="nothing to compare",
        severity=Severity.ERROR,
        rationale="No measured quantity has a prediction, so that the measurement says nothing about the model.",
        remedy="Say with --map and --as what the measured objects are in the model.",
    ),
)
