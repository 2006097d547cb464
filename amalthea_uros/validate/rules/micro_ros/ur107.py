"""Callback in the executor that takes too long."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR107",
    title="callback in the executor that takes longer than its interval",
    severity=Severity.ERROR,
    rationale="The callback is due again before it has finished, and it delays all other callbacks in the executor.",
    remedy="Reduce its execution time, or run it less often.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 2 ms, runs_in: executor}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 200 us, runs_in: executor}
""",
)
