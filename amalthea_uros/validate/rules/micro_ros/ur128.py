"""Build option without effect."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR128",
    title="build option of the middleware without effect",
    severity=Severity.WARNING,
    rationale="The option belongs to another transport, lacks the other one that it needs, or is not read any more: nothing changes.",
    remedy="Remove it here and in the build.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  limits: {RMW_UXRCE_XML_BUFFER_LENGTH: 400}
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
  limits: {RMW_UXRCE_MAX_NODES: 1}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us}
""",
)
