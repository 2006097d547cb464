"""Bus overload."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR131",
    title="messages that need more than the CAN bus can carry",
    severity=Severity.WARNING,
    rationale="Messages queue up and are lost.",
    remedy="Raise the bit rate, or send less often.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {can: {bitrate: 125 kbit/s}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 500 Hz, message_size: 40 B, execution_time: 2 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {can: {bitrate: 1 Mbit/s}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 40 B, execution_time: 2 us}
""",
)
