"""Stream history that the build refuses."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR126",
    title="history of a stream that is not a power of two",
    severity=Severity.WARNING,
    rationale="CMake stops the build of rmw_microxrcedds with an error for any other value.",
    remedy="Set the next power of two.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  limits: {RMW_UXRCE_STREAM_HISTORY: 3}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  limits: {RMW_UXRCE_STREAM_HISTORY: 4}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us}
""",
)
