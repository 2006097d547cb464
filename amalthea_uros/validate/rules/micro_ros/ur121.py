"""Message that is too large."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR121",
    title="message that does not fit into the buffers of its stream",
    severity=Severity.ERROR,
    rationale=(
        "A best-effort message must fit into the MTU, and a reliable one into all buffers of its stream together. "
        "Otherwise it cannot be sent."
    ),
    remedy="Increase RMW_UXRCE_MTU or RMW_UXRCE_STREAM_HISTORY, or reduce the size of the message.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  limits: {RMW_UXRCE_MTU: 512 B, RMW_UXRCE_STREAM_HISTORY: 2}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 1100 B, execution_time: 2 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  limits: {RMW_UXRCE_MTU: 512 B, RMW_UXRCE_STREAM_HISTORY: 4}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 1100 B, execution_time: 2 us}
""",
)
