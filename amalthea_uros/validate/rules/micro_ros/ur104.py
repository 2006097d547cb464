"""Callback on another core."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="UR104",
    title="callback inside the executor, but on another core",
    severity=Severity.ERROR,
    rationale="What runs inside the executor runs on its core.",
    remedy="Leave the core out, or let the callback run in a task of its own.",
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
