"""Too much memory."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR129",
    title="micro-ROS needs more memory than the board has",
    severity=Severity.WARNING,
    rationale="The static memory of the middleware and the stacks do not fit: linking fails, or the heap is too small.",
    remedy="Reduce RMW_UXRCE_MAX_HISTORY first, as each slot has the size of the longest message; then pools and stacks.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz, memories: [{name: RAM, kind: SRAM, size: 20 kB}]}
middleware:
  limits: {RMW_UXRCE_MAX_HISTORY: 8}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz, memories: [{name: RAM, kind: SRAM, size: 20 kB}]}
middleware:
  limits: {RMW_UXRCE_MAX_HISTORY: 1}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us}
""",
)
