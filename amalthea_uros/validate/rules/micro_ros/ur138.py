"""Busy waiting."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR138",
    title="driver that keeps the processor busy",
    severity=Severity.WARNING,
    rationale=(
        "A driver that copies each byte, or whose read call returns at once, keeps the processor busy: tasks of lower priority "
        "wait for it."
    ),
    remedy="Use a driver that waits, e.g. 'dma', or give the executor the lowest priority on its core.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {serial: {driver: {read: interrupt}}}
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
  transport: {serial: {driver: {read: blocking}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 48 B, execution_time: 2 us}
""",
)
