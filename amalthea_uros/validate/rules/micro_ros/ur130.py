"""Chain that nothing carries."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR130",
    title="chain whose members have nothing in common",
    severity=Severity.WARNING,
    rationale="Nothing carries the effect from one member to the next, so that the latency of the chain means nothing.",
    remedy="Name the label by which they communicate, and let the one write it and the other read it.",
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
