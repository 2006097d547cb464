"""Receive buffers of executors that sleep."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR139",
    title="receive buffer that can overflow while the loop sleeps",
    severity=Severity.WARNING,
    rationale=(
        "Between two waits, nothing reads the line: what arrives stays in the receive buffer. When it is full, the driver overwrites "
        "the oldest bytes, so that the frames in it are lost."
    ),
    remedy="Shorten the sleep of the loop, or increase the buffer.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {loop: {spin_some: 100 ms, sleep: 100 ms}}
  transport: {serial: {driver: {read: dma, tick: 1 ms, buffer: 512 B}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Command, topic: command, rate: 50 Hz, message_size: 48 B, execution_time: 2 us, reliability: best-effort}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {loop: {spin_some: 100 ms, sleep: 10 ms}}
  transport: {serial: {driver: {read: dma, tick: 1 ms, buffer: 512 B}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Command, topic: command, rate: 50 Hz, message_size: 48 B, execution_time: 2 us, reliability: best-effort}
""",
)
