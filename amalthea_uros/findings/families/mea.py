"""Findings of measuring times in traces."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="MEA001",
        title="marker that does not occur",
        severity=Severity.ERROR,
        rationale="No frame of the log has the identifier, so nothing is measured with it.",
        remedy="Check the identifier: those of 29 bits have eight digits, those of 11 bits three.",
    ),
    FindingKind(
        id="MEA002",
        title="markers on several buses",
        severity=Severity.WARNING,
        rationale="Frames with the same identifier on two buses may come from two controllers. They are never paired with each other: "
        "each bus is measured separately, under a name that begins with the bus.",
        remedy="Choose the bus, e.g. `--channel can0`.",
    ),
    FindingKind(
        id="MEA003",
        title="value that a frame does not have",
        severity=Severity.WARNING,
        rationale="The payload is shorter than the bytes that should be in it, or its statistics contradict themselves. The frame is "
        "not used.",
        remedy="Check the bytes or the signal, and that the DBC file belongs to the controller.",
    ),
    FindingKind(
        id="MEA004",
        title="job with illegal transitions",
        severity=Severity.WARNING,
        rationale="Its events contradict the state chart, for example two starts without an end, so some are missing. The job is not "
        "measured.",
        remedy="Check whether the recorder lost events.",
    ),
    FindingKind(
        id="MEA005",
        title="nothing measured",
        severity=Severity.ERROR,
        rationale="The trace has no complete job, interval or chain.",
        remedy="Check what was recorded, and the markers.",
    ),
    FindingKind(
        id="MEA006",
        title="lost, duplicated or reordered events",
        severity=Severity.WARNING,
        rationale="Times are missing from the statistics, perhaps the longest ones. What is uncertain is counted and not measured.",
        remedy="Record with less load on the bus, or put a number that counts up into the frames, and state it as counter.",
    ),
    FindingKind(
        id="MEA007",
        title="times of few steps of the clock",
        severity=Severity.WARNING,
        rationale="A single time is wrong by up to a step of the clock. The mean of many is better, if their phases vary.",
        remedy="Use a finer clock, or the mean of many values.",
    ),
    FindingKind(
        id="MEA008",
        title="baseline longer than a time",
        severity=Severity.WARNING,
        rationale="Without the mean of the empty object, some times are negative: that mean does not hold for each of them.",
        remedy="Check that the empty object has the same period and runs on the same core; use the interval of the net times.",
    ),
    FindingKind(
        id="MEA009",
        title="line that is not a measured value",
        severity=Severity.ERROR,
        rationale="The line has too few fields, or something else in the place of a time. It is ignored, so a value is missing.",
        remedy="Correct the line, or the tool that wrote it.",
        fails="""\
object,value_us
Task,12.5
Task,fast
""",
    ),
    FindingKind(
        id="MEA010",
        title="wrong file with markers",
        severity=Severity.ERROR,
        rationale="The file cannot be read, or an object in it has no markers or keys that are not known.",
        remedy="Correct the place; an example: `Task: {start: 0x18000001, end: 0x18000002}`.",
        fails="""\
Task: {start: 0x18000001, stop: 0x18000002}
""",
    ),
    FindingKind(
        id="MEA011",
        title="chain with several routes",
        severity=Severity.WARNING,
        rationale="The stimuli of each route are numbered on their own, so that it is not known which of them a response shows.",
        remedy="Measure the chain between markers at its start and its end.",
    ),
    FindingKind(
        id="MEA012",
        title="empty object that was not measured",
        severity=Severity.ERROR,
        rationale="Its times are to be subtracted from those of others, which therefore still contain the cost of measuring.",
        remedy="Check the markers of the empty object, or give the trace with it: `--baseline-from TRACE`.",
    ),
    FindingKind(
        id="MEA013",
        title="minimum and maximum of a damaged log",
        severity=Severity.WARNING,
        rationale="Many lines cannot be read, so others are probably damaged in a way that leaves them valid: a wrong digit in a time "
        "makes one value longer or shorter. Nothing is paired across the lines that cannot be read.",
        remedy="Copy or record the log again. Means and percentiles change little by a few wrong values, a minimum and a maximum much.",
    ),
    FindingKind(
        id="MEA014",
        title="maximum far from all other times",
        severity=Severity.WARNING,
        rationale="One time is more than ten times as long as the second longest. It is measured, since software that was late once "
        "looks like that; but a clock that was set forward, or an end and a start that are missing, do so too.",
        remedy="Check what happened then. If it was the clock or the recording, measure the part before or after: `--from`, `--to`.",
    ),
)
