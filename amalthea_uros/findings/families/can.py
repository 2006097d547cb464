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
        fails="""\
(1436509052.249713) can0 123#11
(1436509052.250713) can0 123#112
""",
    ),
    FindingKind(
        id="CAN002",
        title="log that ends in the middle of a line",
        severity=Severity.WARNING,
        rationale="The last line has no end. Some of its data may be missing, so it is not used.",
        remedy="Check that the log was written and copied completely.",
        fails="""\
(1436509052.249713) can0 123#11
(1436509052.250713) can0 123#1""",
    ),
    FindingKind(
        id="CAN003",
        title="lost frames",
        severity=Severity.WARNING,
        rationale="The recorder, or the controller, received more frames than it could store. Nothing is paired across the gap.",
        remedy="Record with a larger buffer (`candump -r`) or with filters, or evaluate only the part without gaps.",
        fails="""\
(1436509052.249713) can0 123#11
DROPCOUNT: dropped 12 CAN frames on 'can0' socket (total drops 12)
(1436509052.250713) can0 123#11
""",
    ),
    FindingKind(
        id="CAN004",
        title="error frame",
        severity=Severity.WARNING,
        rationale="The controller reported an error of the bus. A frame that is sent again after an error is late.",
        remedy="Check the wiring, the bit rate and the load of the bus.",
        fails="""\
(1436509052.249713) can0 123#11
(1436509052.250713) can0 20000008#0000040000000000
""",
    ),
    FindingKind(
        id="CAN005",
        title="time stamps with a doubtful meaning",
        severity=Severity.WARNING,
        rationale="The times are differences that are added up, or local dates. A change of the clock cannot be told from a pause.",
        remedy="Record absolute times, as `candump -l` does.",
    ),
    FindingKind(
        id="CAN006",
        title="record that is not a frame",
        severity=Severity.INFO,
        rationale="The log has records of other kinds, such as statistics of the bus, or a damaged line. They are ignored.",
        remedy="Nothing needs to be done, unless a frame is missing.",
    ),
    FindingKind(
        id="CAN007",
        title="channel that the log does not have",
        severity=Severity.ERROR,
        rationale="No frame of the log is of the channel that was asked for.",
        remedy="Name one of the channels of the log.",
    ),
    FindingKind(
        id="CAN008",
        title="log that cannot be read to its end",
        severity=Severity.ERROR,
        rationale="The file is damaged, or not of the format that its name stands for. The frames before that place are used.",
        remedy="Check that the file was written and copied completely, and that its name has the right end.",
    ),
    FindingKind(
        id="CAN009",
        title="clock that steps back",
        severity=Severity.WARNING,
        rationale="Somebody or something set the clock of the recorder. How long the interval across the step was is not known.",
        remedy="Keep the clock from being set while recording, e.g. by a time server.",
        fails="""\
(1436509052.249713) can0 123#11
(1436509051.250713) can0 123#11
""",
    ),
    FindingKind(
        id="CAN010",
        title="unusually long pause between frames",
        severity=Severity.INFO,
        rationale="The bus may have been silent; but a clock that was set forward, or an interrupted recording, looks the same.",
        remedy="Check what happened then; evaluate only the part before or after if it was not the bus.",
        fails="""\
(1436509052.249713) can0 123#11
(1436509052.250713) can0 123#11
(1436509092.251713) can0 123#11
""",
    ),
    FindingKind(
        id="CAN011",
        title="channels with the same identifiers",
        severity=Severity.WARNING,
        rationale=(
            "Either one bus was recorded on two channels, so that each frame is there twice, or two buses use the same identifiers for "
            "different frames."
        ),
        remedy="Choose one of the channels.",
        fails="""\
(1436509052.249713) can0 123#11
(1436509052.249714) can1 123#11
(1436509052.250713) can0 123#12
(1436509052.250714) can1 123#12
""",
    ),
    FindingKind(
        id="CAN012",
        title="description of a bus (DBC) that cannot be read",
        severity=Severity.ERROR,
        rationale="The file is missing, or not a valid DBC file. Nothing is known of the signals in the frames.",
        remedy="Check the path and the place in the file that is stated, or save the file again as DBC.",
    ),
)
