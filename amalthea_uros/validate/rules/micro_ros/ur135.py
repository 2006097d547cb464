"""Drivers that are slower than their line."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR135",
    title="serial line limited by the tick",
    severity=Severity.INFO,
    rationale=(
        "A driver that waits for the end of a transfer in ticks needs a tick for each chunk of 42 bytes, whatever the baud rate."
    ),
    remedy="Use a driver that is woken at the end of a transfer, or a shorter tick.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {serial: {baud_rate: 921600, driver: {write: dma, tick: 1 ms}}}
application:
  nodes:
    - name: node
      publishers:
        - {topic: imu, message_size: 312 B, reliability: best-effort}
      timers:
        - {name: Sample, period: 20 ms, execution_time: 2 us, publishes: [imu]}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {serial: {baud_rate: 921600, driver: {write: blocking, tick: 1 ms}}}
application:
  nodes:
    - name: node
      publishers:
        - {topic: imu, message_size: 312 B, reliability: best-effort}
      timers:
        - {name: Sample, period: 20 ms, execution_time: 2 us, publishes: [imu]}
""",
)
