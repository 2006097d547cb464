"""Bus overload."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR131",
    title="overloaded CAN bus",
    severity=Severity.WARNING,
    rationale="The messages need more time than the bus has: they queue up and are lost.",
    remedy="Increase the bit rate, or send fewer or smaller messages.",
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
