"""Messages that do not fit the transport."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR134",
    title="message too long for the transport",
    severity=Severity.ERROR,
    rationale=("A frame of the transport carries one message of the middleware, and best-effort messages are not fragmented."),
    remedy="Send a smaller message, or send it reliably; for a custom transport, add a row to its table.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {custom: {table: [{size: 64 B, time: 1 ms}]}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 100 B, execution_time: 2 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {custom: {table: [{size: 256 B, time: 1 ms}]}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 100 B, execution_time: 2 us}
""",
)
