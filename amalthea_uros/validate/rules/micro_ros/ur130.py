"""Chain without a data flow or trigger."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR130",
    title="chain element without a data flow or trigger from the one before it",
    severity=Severity.WARNING,
    rationale="No data flow or trigger connects the two elements, so the chain has no meaningful latency.",
    remedy="Add the label by which they communicate: let the first element write it and the second one read it.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: Sense, period: 1 ms, execution_time: 10 us, writes: [speed]}
  - {name: Act, period: 10 ms, execution_time: 10 us}
chains:
  - {name: sense-to-act, path: [Sense, Act]}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: Sense, period: 1 ms, execution_time: 10 us, writes: [speed]}
  - {name: Act, period: 10 ms, execution_time: 10 us, reads: [speed]}
chains:
  - {name: sense-to-act, path: [Sense, Act]}
""",
)
