"""Callback without a fitting period."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR101",
    title="callback that fits no task period on offer",
    severity=Severity.ERROR,
    rationale=(
        "Its task has to run as often as the callback is due, and its period has to be longer than the callback "
        "executes (S. R. Bappanadu 2022, section 4.3); otherwise messages are lost, or jobs do not end in time."
    ),
    remedy="Offer another period, or change the callback.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  task_periods: [10 ms, 20 ms]
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 4 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  task_periods: [1 ms, 10 ms, 20 ms]
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 4 us}
""",
)
