"""Findings of the analysis of event chains."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

_APPLICATION = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  executor: {{name: Executor, loop: {{spin_some: 100 ms, sleep: 10 ms}}, execution_time: 10 us}}
{transport}
application:
  nodes:
    - name: node
      subscriptions: [{{name: drive, topic: cmd_vel, rate: 4 Hz, message_size: 48 B, execution_time: 100 us}}]
chains: [{{name: way, path: {path}}}]
"""
_SERIAL = "  transport: {serial: {baud_rate: 115200}}"

KINDS = (
    FindingKind(
        id="CHN001",
        title="event chain that is not evaluated",
        severity=Severity.WARNING,
        rationale="A part or an event is missing, the chain contains itself, or an event does not mark a single time in each job.",
        remedy="Complete the chain, and set the event type of its events, e.g. start or terminate.",
    ),
    FindingKind(
        id="CHN002",
        title="no data flow or trigger between two events of a chain",
        severity=Severity.WARNING,
        rationale="The chain is not evaluated: nobody stated how its events are connected, so its latencies are unknown.",
        remedy="Model the access or trigger that connects them, or remove the segment from the chain.",
    ),
    FindingKind(
        id="CHN003",
        title="event chain without an upper bound",
        severity=Severity.WARNING,
        rationale="The message gives the reason, for example a task with an unbounded response time.",
        remedy="Fix the cause: see the findings of the task that the message names.",
    ),
    FindingKind(
        id="CHN004",
        title="event that no activity raises",
        severity=Severity.WARNING,
        rationale="Nobody stated when the event occurs, so the chains with it are not evaluated.",
        remedy="Model the activity that raises the event, e.g. a label access.",
    ),
    FindingKind(
        id="CHN005",
        title="segment whose start or end differs from that of the chain",
        severity=Severity.WARNING,
        rationale="The stimulus and response of the chain are used; those of its first or last segment are ignored.",
        remedy="Use the stimulus of the chain in its first segment, and its response in the last one.",
    ),
    FindingKind(
        id="CHN006",
        title="failure in the evaluation of a chain or constraint",
        severity=Severity.ERROR,
        rationale="An error in this program; the chain or constraint is unknown, and everything else is analysed.",
        remedy="Report it to the authors of this program, with the model if possible.",
    ),
    FindingKind(
        id="CHN007",
        title="event chain without a stimulus or response of its own",
        severity=Severity.WARNING,
        rationale="Its latencies start at the stimulus of the first segment, or end at the response of the last one, which may not be "
        "what the chain is meant to cover.",
        remedy="Set the stimulus and the response of the chain.",
    ),
    FindingKind(
        id="CHN008",
        title="empty event set in a chain",
        severity=Severity.WARNING,
        rationale="The chain is evaluated without this set, so it can start or end elsewhere.",
        remedy="Add events to the set, or use an event instead.",
    ),
    FindingKind(
        id="CHN009",
        title="latency of messages without an upper bound",
        severity=Severity.WARNING,
        rationale="The latency is the sum of the bounds of its hops: the agent, wires, executors, tasks. The message names the hop "
        "that has none, or how messages can be lost.",
        remedy="State or change what the message names. `amuros analyze --explain` with the name of the chain shows all hops.",
        fails=_APPLICATION.format(transport=_SERIAL, path="[/cmd_vel, drive]"),
    ),
    FindingKind(
        id="CHN010",
        title="topic in a chain without a transport",
        severity=Severity.WARNING,
        rationale="A chain that begins or ends with a topic passes the wire and the agent. Unless they are described, "
        "it has no latency.",
        remedy="Describe the transport and the agent of the middleware.",
        fails=_APPLICATION.format(transport="", path="[/cmd_vel, drive]"),
    ),
    FindingKind(
        id="CHN011",
        title="topic in a chain that is not the one of its neighbours",
        severity=Severity.ERROR,
        rationale="A topic in a path stands for a message: the one that the callback before it publishes, and that the callback "
        "after it receives. There is none, or more than one.",
        remedy="Put the topic next to the callback that publishes or receives it.",
        fails=_APPLICATION.format(transport=_SERIAL, path="[drive, /cmd_vel]"),
    ),
)
