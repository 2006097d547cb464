"""Findings of the simulation."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="SIM001",
        title="process that is not simulated",
        severity=Severity.ERROR,
        rationale=(
            "Something that the model does not state, or that the simulation does not know, is needed to execute the process. It is "
            "left out, so that the others are observed as if it did not exist."
        ),
        remedy="State what is missing, or take the construct out of the model.",
    ),
    FindingKind(
        id="SIM002",
        title="chain that is not followed",
        severity=Severity.WARNING,
        rationale="An event of the chain has no known place, or the effect takes a way whose time is unknown.",
        remedy="Refer to events of processes, runnables or labels that occur in the model.",
    ),
    FindingKind(
        id="SIM003",
        title="job that never ends",
        severity=Severity.ERROR,
        rationale="A job executes activities forever without taking time, so that the simulation cannot go on.",
        remedy="Check the conditions of its loops, and that something in them takes time.",
    ),
    FindingKind(
        id="SIM004",
        title="elements lost in a channel",
        severity=Severity.WARNING,
        rationale="A channel was full when something was put into it.",
        remedy="Receive more often, or give the channel a greater capacity.",
    ),
    FindingKind(
        id="SIM005",
        title="messages lost in a full queue",
        severity=Severity.WARNING,
        rationale="A message arrived while as many as the middleware keeps were waiting: the executor takes one in a job at most.",
        remedy="Run the executor more often, or send less often.",
    ),
    FindingKind(
        id="SIM006",
        title="loop of an executor that is not played",
        severity=Severity.WARNING,
        rationale=(
            "When the rounds of an executor follow each other, and what each of them calls, depends on its loop and on what has "
            "arrived. The simulation executes a round per job of a task, whose activations and branches only stand for that: its load "
            "is of the right size, but no time of a callback or of a message is one that the executor would have."
        ),
        remedy="Use `amuros analyze`, which bounds response times, lateness and the latency of messages from the loop itself.",
    ),
)
