"""Service called by a process."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Process, Runnable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import called
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element.service:
        for process in context.once(_processes).get(element, {}):
            yield f"service {element.name!r} is called directly by {process.name!r}"


def _processes(context: Context) -> dict[Runnable, dict[Process, None]]:
    """The processes that call each runnable directly."""
    found: dict[Runnable, dict[Process, None]] = {}
    for process in context.all(Process):
        for runnable in called(process, context):
            found.setdefault(runnable, {})[process] = None
    return found


RULE = ModelRule(
    id="DOC-Service-Caller",
    title="service called by a process",
    severity=Severity.INFO,
    target=Runnable,
    check=_check,
    rationale="A service is meant for other runnables. The APP4MC documentation requires that only runnables call it.",
    remedy="Call the service from a runnable, or do not mark it as a service.",
    fails="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="S?type=Runnable"/>
    </activityGraph>
  </tasks>
  <runnables name="S" service="true"/>
</swModel>
""",
    passes="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </tasks>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="S?type=Runnable"/>
    </activityGraph>
  </runnables>
  <runnables name="S" service="true"/>
</swModel>
""",
)
