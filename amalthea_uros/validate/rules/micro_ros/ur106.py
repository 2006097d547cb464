"""Equal preset priorities."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR106",
    title="two tasks of a core with the same preset priority",
    severity=Severity.WARNING,
    rationale="Tasks of equal priority run in the order of their activation, so each of them may have to wait for the other.",
    remedy="Set different priorities.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: Fast, period: 1 ms, execution_time: 10 us, priority: 1}
  - {name: Slow, period: 10 ms, execution_time: 10 us, priority: 1}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: Fast, period: 1 ms, execution_time: 10 us, priority: 2}
  - {name: Slow, period: 10 ms, execution_time: 10 us, priority: 1}
""",
)
