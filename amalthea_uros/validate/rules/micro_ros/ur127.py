"""Name that is too long."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR127",
    title="name of a node, topic or service that is too long for the middleware",
    severity=Severity.ERROR,
    rationale="rmw_microxrcedds copies names into buffers of fixed size; creating an entity with a longer name fails.",
    remedy="Use a shorter name, or increase the length of names in the build and under 'limits'.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  limits: {RMW_UXRCE_TOPIC_NAME_MAX_LENGTH: 7}
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
  limits: {RMW_UXRCE_TOPIC_NAME_MAX_LENGTH: 8}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us}
""",
)
