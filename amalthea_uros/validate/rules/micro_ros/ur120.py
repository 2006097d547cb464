"""Static pool that is too small."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR120",
    title="static pool of the middleware that is too small",
    severity=Severity.ERROR,
    rationale="rmw_microxrcedds does not allocate memory at run time: creating an entity fails when its pool is full.",
    remedy=(
        "Set the build option to the number of entities that the application needs, and repeat it under 'limits'. For messages that "
        "wait, the number is a lower bound: 'amuros generate' computes how many slots are enough."
    ),
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  limits: {RMW_UXRCE_MAX_SUBSCRIPTIONS: 0}
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
  limits: {RMW_UXRCE_MAX_SUBSCRIPTIONS: 1}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us}
""",
)
