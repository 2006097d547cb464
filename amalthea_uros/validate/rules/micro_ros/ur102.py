"""Period of the author."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR102",
    title="stated task period that breaks the execution mapping",
    severity=Severity.ERROR,
    rationale=(
        "A task that runs less often than messages come loses some, and one whose period is not longer than its "
        "callback executes does not end in time (S. R. Bappanadu 2022, section 4.3)."
    ),
    remedy=(
        "State a period that is on offer, at most as long as the interval of the callback, and longer than its execution time."
    ),
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  task_periods: [1 ms, 20 ms, 100 ms]
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us, task_period: 100 ms}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  task_periods: [1 ms, 20 ms, 100 ms]
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us, task_period: 20 ms}
""",
)
