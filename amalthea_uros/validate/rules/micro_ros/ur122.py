"""No acknowledgement time."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR122",
    title="reliable message without an acknowledgement time",
    severity=Severity.WARNING,
    rationale=(
        "A reliable message occupies the stream until the agent acknowledges it. Without the acknowledgement time, "
        "neither the occupancy of the stream nor the blocking of the sender has an upper bound."
    ),
    remedy="Set 'acknowledgement' under 'transport', or use 'reliability: best-effort'.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
application:
  nodes:
    - name: node
      publishers:
        - {topic: state, message_size: 8 B}
      timers:
        - {name: Control, period: 10 ms, execution_time: 4 us, publishes: [state]}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {acknowledgement: 10 ms}
application:
  nodes:
    - name: node
      publishers:
        - {topic: state, message_size: 8 B}
      timers:
        - {name: Control, period: 10 ms, execution_time: 4 us, publishes: [state]}
""",
)
