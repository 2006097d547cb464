"""Reliable message."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR122",
    title="reliable message without a time of acknowledgement",
    severity=Severity.WARNING,
    rationale=(
        "It stays in the stream until the agent acknowledges it; without that time nothing is known of how long the "
        "stream is occupied, nor of how long its sender may have to wait."
    ),
    remedy="State how long an acknowledgement takes at most, or send with best effort.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
application:
  nodes:
    - name: node
      publishers:
        - {topic: state, message_size: 8 B}
      timers:
        - {name: Control, period: 10 ms, execution_time: 4 us, publishes: [state]}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {acknowledgement: 10 ms}
application:
  nodes:
    - name: node
      publishers:
        - {topic: state, message_size: 8 B}
      timers:
        - {name: Control, period: 10 ms, execution_time: 4 us, publishes: [state]}
""",
)
