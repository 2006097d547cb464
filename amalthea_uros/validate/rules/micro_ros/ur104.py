"""Callback in the executor with another core."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR104",
    title="callback in the executor that is assigned to another core",
    severity=Severity.ERROR,
    rationale="A callback in the executor runs on the core of the executor.",
    remedy="Remove 'core', or set 'runs_in: own-task'.",
    fails="""
amuros: 1
name: app
hardware: {platform: bodas-rc18-12-40}
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 4 us, runs_in: executor, core: Core_1}
""",
    passes="""
amuros: 1
name: app
hardware: {platform: bodas-rc18-12-40}
application:
  nodes:
    - name: node
      timers:
        - {name: Control, period: 1 ms, execution_time: 4 us, runs_in: own-task, core: Core_1}
""",
)
