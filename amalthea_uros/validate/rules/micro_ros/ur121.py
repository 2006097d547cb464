"""Message that is too large."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR121",
    title="message that is too long for the middleware",
    severity=Severity.ERROR,
    rationale=(
        "A best-effort message must fit into the MTU of the transport, and a reliable one that arrives into all buffers of its stream "
        "together. One that is longer is never sent or received."
    ),
    remedy="Increase the MTU or RMW_UXRCE_STREAM_HISTORY, reduce the size of the message, or send it reliably, in fragments.",
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
