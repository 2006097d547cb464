"""Findings about the content of an app.yaml."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="APP001",
        title="undefined name",
        severity=Severity.ERROR,
        rationale="The platform, core, memory, label, process, runnable, callback, publisher, client or chain of that name is not "
        "defined.",
        remedy="Correct the name, or define it.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: 1 ms}
requirements:
  - {process: U, response_time: 1 ms}
""",
    ),
    FindingKind(
        id="APP002",
        title="duplicate name",
        severity=Severity.ERROR,
        rationale="Two objects have the same name, or a runnable is described in two different ways.",
        remedy="Give one of them another name.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: 1 ms}
  - {name: T, period: 20 ms, execution_time: 1 ms}
""",
    ),
    FindingKind(
        id="APP003",
        title="missing or contradictory keys",
        severity=Severity.ERROR,
        rationale="The keys of a section contradict each other, or one that they need is missing.",
        remedy="Follow the advice at the finding; docs/app-yaml-reference.md lists which keys go together.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, execution_time: 1 ms}
""",
    ),
    FindingKind(
        id="APP004",
        title="invalid event chain",
        severity=Severity.ERROR,
        rationale="The chain contains itself, its parts do not fit together, or it has no start and end.",
        remedy="Let each part start with the event with which the part before it ends.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: 1 ms}
chains:
  - {name: C, path: [T, T]}
""",
    ),
    FindingKind(
        id="APP005",
        title="core without a clock frequency",
        severity=Severity.ERROR,
        rationale="Execution times cannot be converted to ticks of the core.",
        remedy="Give hardware.frequency, for example frequency: 300 MHz, or choose a platform.",
        fails="""
amuros: 1
name: app
hardware: {cores: 1}
tasks:
  - {name: T, period: 10 ms, execution_time: 1 ms}
""",
    ),
    FindingKind(
        id="APP006",
        title="no execution time for the platform",
        severity=Severity.ERROR,
        rationale="The execution time is given for other platforms only.",
        remedy="Add the platform, or default, to the section on of the execution time.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: {on: {esp32: 1 ms}}}
""",
    ),
    FindingKind(
        id="APP007",
        title="execution time that is not a whole number of ticks",
        severity=Severity.INFO,
        rationale="AMALTHEA counts execution times in ticks. The time is rounded up.",
        remedy="Accept the rounding, or give a time that is a multiple of a tick.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 3 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: 1.1 us}
""",
    ),
    FindingKind(
        id="APP008",
        title="label that is only read, with a name similar to one that is only written",
        severity=Severity.WARNING,
        rationale=(
            "One of the two names is probably misspelled; then data flows between the runnables that the model does not show."
        ),
        remedy="Correct the name, or list both under labels if they are different.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: 1 ms, writes: [speed]}
  - {name: U, period: 10 ms, execution_time: 1 ms, reads: [sped]}
""",
    ),
    FindingKind(
        id="APP009",
        title="description without anything to run",
        severity=Severity.ERROR,
        rationale="A model needs at least one task, interrupt service routine or callback.",
        remedy="Add callbacks under application, or tasks.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
""",
    ),
)
