"""Sleep that is no whole number of ticks."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR161",
    title="sleep that is not a multiple of the tick",
    severity=Severity.WARNING,
    rationale=(
        "Operating systems count sleeps in ticks: the time is rounded up, and the sleep ends at a tick. With the tick of 10 ms "
        "of ESP-IDF, a sleep of 15 ms lasts 10 ms to 20 ms."
    ),
    remedy="Sleep for a whole number of ticks, or shorten the tick of the operating system, and set 'tick' under 'os'.",
    fails="""
amuros: 1
name: app
hardware: {platform: esp32}
middleware: {executor: {loop: {spin_some: 100 ms, sleep: 15 ms}, execution_time: 50 us}}
application:
  nodes:
    - name: node
      timers: [{name: Control, period: 500 ms, execution_time: 40 us}]
""",
    passes="""
amuros: 1
name: app
hardware: {platform: esp32}
middleware: {executor: {loop: {spin_some: 100 ms, sleep: 20 ms}, execution_time: 50 us}}
application:
  nodes:
    - name: node
      timers: [{name: Control, period: 500 ms, execution_time: 40 us}]
""",
)
