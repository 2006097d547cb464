"""Findings of reading, checking and writing traces."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="TRC001",
        title="trace file that cannot be read",
        severity=Severity.ERROR,
        rationale="The file is missing or a directory, or access to it is denied. Nothing is known of its events.",
        remedy="Check the path and the permissions.",
    ),
    FindingKind(
        id="TRC002",
        title="line that is not an event",
        severity=Severity.ERROR,
        rationale="The line has too few fields, or something else in the place of a number. It is ignored, so an event is missing.",
        remedy="Correct the line, or the tool that wrote it.",
        fails="""\
#version 2.3.0
#timeScale ns
0,Core_0,0,T,Task
""",
    ),
    FindingKind(
        id="TRC003",
        title="unknown event",
        severity=Severity.WARNING,
        rationale="The format does not define the event for entities of this type, or the event is not about scheduling, interrupts, "
        "runnables or data. It is ignored.",
        remedy="Check the spelling; if the event is an extension of another tool, nothing needs to be done.",
        fails="""\
#version 2.3.0
#timeScale ns
0,Core_0,0,T,Task,0,begin
""",
    ),
    FindingKind(
        id="TRC004",
        title="time that decreases",
        severity=Severity.ERROR,
        rationale="The lines of a trace are in the order of time. The event is ignored, because it is not known when it occurred.",
        remedy="Sort the events by time without changing the order of those at the same time.",
        fails="""\
#version 2.3.0
#timeScale ns
1000,Stimulus,0,T,Task,0,activate
500,Core_0,0,T,Task,0,start
""",
    ),
    FindingKind(
        id="TRC005",
        title="header that is missing or incomplete",
        severity=Severity.WARNING,
        rationale="The header states the unit of the times and the version of the format; a wrong unit makes all results wrong.",
        remedy="Add the missing line, e.g. `#timescale ns`.",
        fails="""\
0,Stimulus,0,T,Task,0,activate
""",
    ),
    FindingKind(
        id="TRC006",
        title="damaged compressed trace",
        severity=Severity.ERROR,
        rationale="The file ends early or is damaged. The events before that place are used.",
        remedy="Check that the file was written and copied completely.",
    ),
    FindingKind(
        id="TRC010",
        title="illegal transition of a task or ISR",
        severity=Severity.ERROR,
        rationale="The state chart of BTF does not allow the event in this state. Times in states are then not reliable.",
        remedy="Check for lost events, and whether the tool that wrote the trace follows BTF 2.3.0.",
        fails="""\
#version 2.3.0
#timeScale ns
0,Stimulus,0,T,Task,0,activate
100,Core_0,0,T,Task,0,terminate
""",
    ),
    FindingKind(
        id="TRC011",
        title="illegal transition of a runnable",
        severity=Severity.ERROR,
        rationale=(
            "A runnable executes only while its process does: it is suspended before the process leaves the core and resumed after it "
            "is back, and runnables in runnables are nested. Execution times of runnables are then not reliable."
        ),
        remedy="Check for lost events, and the order of events at the same time.",
    ),
    FindingKind(
        id="TRC012",
        title="illegal transition of a semaphore",
        severity=Severity.ERROR,
        rationale="The state chart of semaphores, or the order of request, assignment and release, does not allow the event.",
        remedy="Check for lost events, and whether the tool that wrote the trace follows BTF 2.3.0.",
    ),
    FindingKind(
        id="TRC013",
        title="instance numbers with gaps",
        severity=Severity.ERROR,
        rationale="Each activation, start of a runnable or trigger has the next number; a gap means lost events.",
        remedy="Record the trace with a larger buffer, or evaluate only the part without gaps.",
    ),
    FindingKind(
        id="TRC014",
        title="effect of a stimulus without its trigger",
        severity=Severity.ERROR,
        rationale="BTF wants the trigger of a stimulus before the activations that it causes; chains cannot be followed otherwise.",
        remedy="Write the trigger event before its effects.",
    ),
    FindingKind(
        id="TRC015",
        title="action of a process that is not running",
        severity=Severity.ERROR,
        rationale="Only a running process reads, writes, requests semaphores, or executes runnables.",
        remedy="Check for lost events, and the order of events at the same time.",
    ),
    FindingKind(
        id="TRC016",
        title="core that executes two processes",
        severity=Severity.ERROR,
        rationale="A core executes one process at a time, which leaves it on the same core.",
        remedy="Write the event with which a process leaves the core before that with which the next one enters it.",
    ),
    FindingKind(
        id="TRC020",
        title="damaged part of a CTF trace",
        severity=Severity.ERROR,
        rationale="The bytes do not fit the metadata, or the file ends within a packet. Events are left out up to the next packet, and "
        "intervals that are open there are dropped.",
        remedy="Check that the files were copied completely, and that `metadata` is of the build that was recorded.",
    ),
    FindingKind(
        id="TRC021",
        title="event that does not follow from those before",
        severity=Severity.WARNING,
        rationale="A thread leaves a core on which it was not, or an interval ends that has not begun: events between are missing. "
        "At the begin of a recording this is normal.",
        remedy="Record into a larger buffer, or fewer kinds of events.",
    ),
    FindingKind(
        id="TRC022",
        title="events that the recorder has lost",
        severity=Severity.WARNING,
        rationale="The recorder says itself that events or packets are missing. Intervals that are open there are dropped, so maxima "
        "may be missing.",
        remedy="Record into a larger buffer, or fewer kinds of events.",
    ),
    FindingKind(
        id="TRC023",
        title="doubtful overflow of the clock",
        severity=Severity.WARNING,
        rationale="A stamp of less than 64 bits is less than the one before, and the pause that this means is much longer than all "
        "pauses before. In older releases of Zephyr stamps start again whenever the cycle counter does. Intervals that are open "
        "there are dropped; times after it may be too late by a constant.",
        remedy="Record with stamps of 64 bits.",
    ),
    FindingKind(
        id="TRC024",
        title="metadata of a CTF trace that cannot be understood",
        severity=Severity.ERROR,
        rationale="The file `metadata` says what the bytes of the events mean; without it nothing can be read.",
        remedy="Copy `metadata` from the build that was recorded.",
    ),
    FindingKind(
        id="TRC025",
        title="messages of ROS 2 that cannot be followed",
        severity=Severity.INFO,
        rationale="A publication is matched with its callback by the topic and the source stamp. Where one is missing, callbacks are "
        "measured, but not the latency of the message.",
        remedy="Start the recording before the nodes, and record `rmw_publish` and `rmw_take` of all processes.",
    ),
    FindingKind(
        id="TRC101",
        title="trace that cannot be written",
        severity=Severity.ERROR,
        rationale="The place does not exist, is full, or may not be written to. A former file is untouched.",
        remedy="Check the path, the permissions and the free space.",
    ),
)
