"""Same priority."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR106",
    title="two tasks of a core with the same stated priority",
    severity=Severity.WARNING,
    rationale="They are served in the order of their activation, so that each may have to wait for the other.",
    remedy="Give each a priority of its own.",
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
