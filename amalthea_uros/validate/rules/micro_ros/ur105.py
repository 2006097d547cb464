"""No gap between preset priorities."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR105",
    title="rate-monotonic priority that does not fit between preset priorities",
    severity=Severity.WARNING,
    rationale=(
        "The preset priorities leave no number for the task, so its priority becomes higher than that of a task with a "
        "shorter or equal period."
    ),
    remedy="Set the priority of this task as well, or leave gaps between the preset priorities.",
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
