"""Findings of putting measured values into a description."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="CAL001",
        title="value of the description that the measurement refutes",
        severity=Severity.ERROR,
        rationale="A measured value is beyond what the description states, so all results that were computed with it were too good.",
        remedy="Check what was measured; the calibrated description has the measured value. Analyse it again.",
    ),
    FindingKind(
        id="CAL002",
        title="measured maximum as a bound",
        severity=Severity.INFO,
        rationale="A measured maximum is a high-water mark: it bounds the worst case from below, and longer execution times can occur. "
        "The margin that is added to it is an assumption.",
        remedy="Measure longer and with the inputs that take longest, or use bounds that are derived otherwise.",
    ),
    FindingKind(
        id="CAL003",
        title="measured value that is not written",
        severity=Severity.WARNING,
        rationale="The description has no place for the value, for example because it is a sum of several stated times.",
        remedy="Measure the parts one by one, or change the description by hand.",
    ),
    FindingKind(
        id="CAL004",
        title="description that allows more than was measured",
        severity=Severity.INFO,
        rationale="The stated range includes all measured values. That others cannot occur is not proved by measuring, so it stays.",
        remedy="Narrow it with `--tighten` if the stated range was only a guess.",
    ),
    FindingKind(
        id="CAL005",
        title="gross times as execution times",
        severity=Severity.WARNING,
        rationale="What lies between two markers includes preemption by other processes, which an analysis adds once more.",
        remedy="Trace the processes so that net execution times are known, or measure while nothing preempts them.",
    ),
    FindingKind(
        id="CAL006",
        title="process that was not measured",
        severity=Severity.INFO,
        rationale="Its values in the description stay as they are, and the results depend on them, too.",
        remedy="Measure it if its values are guesses.",
    ),
    FindingKind(
        id="CAL007",
        title="values that the calibration does not predict",
        severity=Severity.ERROR,
        rationale="Values on which the calibration is judged (`--judge-on`) are outside the calibrated range, so more will be.",
        remedy="Use all values, a larger margin, or a longer trace.",
    ),
    FindingKind(
        id="CAL008",
        title="measured object that the description does not have",
        severity=Severity.INFO,
        rationale="Its times are not used. It may be an empty task for baselines, or a misspelled name.",
        remedy="Check the name; in CAN logs, it is that of the markers.",
    ),
)
