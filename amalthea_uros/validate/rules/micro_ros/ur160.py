"""Priority that the operating system does not have."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR160",
    title="priority outside the range of the operating system",
    severity=Severity.WARNING,
    rationale=(
        "An operating system has a fixed range of priorities, such as 0 to 24 in ESP-IDF. Creating a task with another priority "
        "fails, or the operating system uses the nearest one, so that tasks share a priority."
    ),
    remedy="Set a priority in the range, or state the range of the operating system with 'priority_range' under 'os'.",
    fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
os: {rtos: zephyr}
tasks:
  - {name: Control, period: 10 ms, priority: 20, execution_time: 4 us}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
os: {rtos: zephyr}
middleware: {executor: {period: 10 ms, execution_time: 4 us}}
tasks:
  - {name: Control, period: 10 ms, priority: 14, execution_time: 4 us}
""",
)
