"""Receive buffers."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR137",
    title="receive buffer smaller than a message",
    severity=Severity.WARNING,
    rationale=(
        "What arrives when the receive buffer is full is lost. In a frame, each byte can be escaped, so that it needs two."
    ),
    remedy="Increase the buffer.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {serial: {driver: {buffer: 64 B}}}
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
  transport: {serial: {driver: {buffer: 2 kB}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 48 B, execution_time: 2 us}
""",
)
