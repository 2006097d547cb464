"""Priority without room."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR105",
    title="rate-monotonic priority that does not fit between stated ones",
    severity=Severity.WARNING,
    rationale="A task gets a higher priority than one that is more frequent, or that was stated to come first.",
    remedy="State its priority, too, or leave room between the stated ones.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: Fast, period: 1 ms, execution_time: 10 us, priority: 1}
  - {name: Slow, period: 10 ms, execution_time: 10 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: Fast, period: 1 ms, execution_time: 10 us, priority: 2}
  - {name: Slow, period: 10 ms, execution_time: 10 us}
""",
)
