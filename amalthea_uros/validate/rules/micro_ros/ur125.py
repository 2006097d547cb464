"""Histories that the middleware cannot hold."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR125",
    title="history that is deeper than the storage for messages",
    severity=Severity.WARNING,
    rationale=(
        "All subscriptions, services and clients share RMW_UXRCE_MAX_HISTORY slots. When they are used up, a new message of any topic "
        "is dropped, whatever the depth of its history."
    ),
    remedy="Set RMW_UXRCE_MAX_HISTORY to the messages that can wait at the same time, or a smaller 'depth'.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us, depth: 20}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 4 B, execution_time: 2 us, depth: 2}
""",
)
