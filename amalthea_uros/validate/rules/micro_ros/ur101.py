"""No task period for a callback."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR101",
    title="callback without a suitable task period",
    severity=Severity.ERROR,
    rationale=(
        "The task of a callback must run at least as often as the callback is due, and its period must be longer than "
        "the execution time of the callback (S. R. Bappanadu 2022, section 4.3). Otherwise messages are lost, or jobs do "
        "not finish within their period."
    ),
    remedy="Add a suitable period to 'task_periods', or change the interval or the execution time of the callback.",
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
