"""Foreign frames without a cycle time."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR133",
    title="foreign frame without a cycle time",
    severity=Severity.WARNING,
    rationale=(
        "A frame of others with a higher priority delays the messages of the application. If it is unknown how often it comes, "
        "there is no bound on their waiting."
    ),
    remedy="Describe the frame under 'foreign' with its period, or state GenMsgCycleTime in the DBC file.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport:
    can_fd:
      bitrate: 500 kbit/s
      data_bitrate: 2 Mbit/s
      foreign: [{name: Brake, identifier: 0x10}]
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 40 B, execution_time: 2 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  transport:
    can_fd:
      bitrate: 500 kbit/s
      data_bitrate: 2 Mbit/s
      foreign: [{name: Brake, identifier: 0x10, period: 10 ms}]
application:
  nodes:
    - name: node
      subscriptions:
        - {name: Factor, topic: factor, rate: 50 Hz, message_size: 40 B, execution_time: 2 us}
""",
)
