"""Wire overload."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR132",
    title="overloaded wire",
    severity=Severity.WARNING,
    rationale=(
        "The messages need more time than the wire has: they wait ever longer, in the agent for up to 32000 messages, and are "
        "then lost. What they need counts acknowledgements, escaped bytes, and the time in which the driver waits for ticks."
    ),
    remedy="Increase the baud rate or the bit rate, send best effort, or send fewer or smaller messages.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {serial: {baud_rate: 9600}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 48 B, execution_time: 2 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {serial: {baud_rate: 921600}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 48 B, execution_time: 2 us}
""",
)
