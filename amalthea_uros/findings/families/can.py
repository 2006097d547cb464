"""Findings of reading logs of CAN buses."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="CAN001",
        title="line or record that is not a frame",
        severity=Severity.ERROR,
        rationale="The line is damaged, or has no time stamp or one that cannot be right. It is ignored, so a frame may be missing.",
        remedy="Check that the log is complete. candump writes time stamps with `-l`, `-L` or `-ta`.",
    ),
    FindingKind(
        id="CAN002",
        title="log that ends in the middle of a line",
        severity=Severity.WARNING,
        rationale="The last line has no end. Some of its data may be missing, so it is not used.",
        remedy="Check that the log was written and copied completely.",
    ),
    FindingKind(
        id="CAN003",
        title="lost frames",
        severity=Severity.WARNING,
        rationale="The recorder, or the controller, received more frames than it could store. Nothing is paired across the gap.",
        remedy="Record with a larger buffer (`candump -r`) or with filters, or evaluate only the part without gaps.",
    ),
    FindingKind(
        id="CAN004",
        title="error frame",
        severity=Severity.WARNING,
        rationale="The controller reported an error of the bus. A frame that is sent again after an error is late.",
        remedy="Check the wiring, the bit rate and the load of the bus.",
    ),
    FindingKind(
        id="CAN005",
        title="time stamps with a doubtful meaning",
        severity=Severity.WARNING,
        rationale="The times are differences that are added up, or local dates. A change of the clock cannot be told from a pause.",
        remedy="Record absolute times, as `candump -l` does.",
    ),
    FindingKind(
        id="CAN007",
        title="channel that the log does not have",
        severity=Severity.ERROR,
        rationale="No frame of the log is of the channel that was asked for.",
        remedy="Name one of the channels of the log.",
    ),
)
