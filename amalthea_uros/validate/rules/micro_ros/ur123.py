"""Too few stream buffers."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR123",
    title="reliable stream with too few buffers for unacknowledged messages",
    severity=Severity.WARNING,
    rationale="When all buffers wait for acknowledgement, nothing more can be sent: the sender waits, or the message is lost.",
    remedy="Increase RMW_UXRCE_STREAM_HISTORY, or send less often.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {acknowledgement: 50 ms}
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
  transport: {acknowledgement: 50 ms}
  limits: {RMW_UXRCE_STREAM_HISTORY: 5}
application:
  nodes:
    - name: node
      publishers:
        - {topic: state, message_size: 8 B}
      timers:
        - {name: Control, period: 10 ms, execution_time: 4 us, publishes: [state]}
""",
)
