"""Executor period that is too long."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR103",
    title="executor that runs less often than a callback",
    severity=Severity.ERROR,
    rationale=(
        "The executor passes messages to the tasks of the callbacks, so it must run at least as often as the fastest of "
        "them (S. R. Bappanadu 2022, section 4.3)."
    ),
    remedy="Set an executor period that is not longer than the period of any callback.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {period: 10 ms, execution_time: 12 us}
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 4 us, runs_in: executor}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {period: 1 ms, execution_time: 12 us}
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 4 us, runs_in: executor}
""",
)
