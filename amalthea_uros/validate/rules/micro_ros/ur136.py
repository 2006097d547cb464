"""Unspecified times on the way of messages."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR136",
    title="unspecified time in a driver or a task of the middleware",
    severity=Severity.WARNING,
    rationale=(
        "A driver that waits in ticks takes an unknown time if the tick is not specified, and a task of the middleware if its "
        "execution time is not: then the latency of all messages that pass it is unknown."
    ),
    remedy="Specify the tick of the driver or of the operating system, or the execution time of the task.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {serial: {driver: {read: dma}}}
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
  transport: {serial: {driver: {read: dma, tick: 1 ms}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 48 B, execution_time: 2 us}
""",
)
