"""No acknowledgement time."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR122",
    title="reliable message without an acknowledgement time",
    severity=Severity.WARNING,
    rationale=(
        "The callback that sends a reliable message waits until the agent has acknowledged it, up to 1 s by default. Without the "
        "acknowledgement time, nothing shorter than that is certain."
    ),
    remedy=(
        "Set 'acknowledgement' under 'transport', use 'reliability: best-effort', or 'reliable: {waits: false}' for ports that do "
        "not wait."
    ),
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
