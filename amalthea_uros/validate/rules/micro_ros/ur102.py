"""Task period that violates the execution mapping."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR102",
    title="task period that violates the execution mapping",
    severity=Severity.ERROR,
    rationale=(
        "A task that runs less often than messages arrive loses messages, and a job whose execution time is not shorter "
        "than the period does not finish in time (S. R. Bappanadu 2022, section 4.3)."
    ),
    remedy=(
        "Set a period from 'task_periods' that is not longer than the interval of the callback and longer than its "
        "execution time, e.g. 'task_period: 20 ms'."
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
