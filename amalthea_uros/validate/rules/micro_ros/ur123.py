"""Too few stream buffers."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR123",
    title="reliable stream with too few buffers",
    severity=Severity.WARNING,
    rationale=(
        "A message of more fragments than the stream has buffers is sent in steps, and its sender waits for the acknowledgement of "
        "each. In ports that do not wait, messages are lost when all buffers wait for acknowledgement."
    ),
    remedy="Increase RMW_UXRCE_STREAM_HISTORY, or send less data.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  reliable: {waits: false}
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
  reliable: {waits: false}
  transport: {acknowledgement: 50 ms}
  limits: {RMW_UXRCE_STREAM_HISTORY: 8}
application:
  nodes:
    - name: node
      publishers:
        - {topic: state, message_size: 8 B}
      timers:
        - {name: Control, period: 10 ms, execution_time: 4 us, publishes: [state]}
""",
)
