"""Callback longer than its period."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR107",
    title="callback inside the executor that is longer than its period",
    severity=Severity.ERROR,
    rationale="It is due again before it has ended, and holds up all others inside the executor.",
    remedy="Shorten it, or let it be due less often.",
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
