"""Sending that waits."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR124",
    title="sending that waits",
    severity=Severity.WARNING,
    rationale=(
        "A callback that waits for an acknowledgement delays everything that runs after it in its task. With several threads, one that "
        "waits for messages keeps the others from sending."
    ),
    remedy=(
        "Describe the 'loop' of the executor, so that waiting is analyzed; use 'reliability: best-effort', short timeouts, or "
        "'reliable: {waits: false}' for ports that do not wait."
    ),
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport: {acknowledgement: 5 ms}
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
  reliable: {waits: false}
  transport: {acknowledgement: 5 ms}
application:
  nodes:
    - name: node
      publishers:
        - {topic: state, message_size: 8 B}
      timers:
        - {name: Control, period: 10 ms, execution_time: 4 us, publishes: [state]}
""",
)
