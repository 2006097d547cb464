"""Runnable shared by several operating systems."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IExecutable, ISRAllocation, OperatingSystem, Runnable, RunnableCall, TaskAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    systems = context.once(_systems).get(element, [])
    if len(systems) > 1:
        yield f"the runnable {element.name or ''!r} is used by the operating systems {systems[0].name!r} and {systems[1].name!r}"


def _systems(context: Context) -> dict[Runnable, list[OperatingSystem]]:
    """The operating systems whose processes call a runnable, at most two."""
    calls: dict[IExecutable, list[Runnable]] = {}
    for call in context.all(RunnableCall):
        caller = call.enclosing(IExecutable)
        if caller is not None and call.runnable is not None:
            calls.setdefault(caller, []).append(call.runnable)
    found: dict[Runnable, list[OperatingSystem]] = {}
    for system, process in _processes(context):
        pending = [process]
        while pending:
            for called in calls.get(pending.pop(), []):
                systems = found.setdefault(called, [])
                if system not in systems and len(systems) < 2:
                    systems.append(system)
                    pending.append(called)
    return found


def _processes(context: Context) -> Iterator[tuple[OperatingSystem, IExecutable]]:
    allocations = [(a.scheduler, a.task) for a in context.all(TaskAllocation)]
    interrupts = [(a.controller, a.isr) for a in context.all(ISRAllocation)]
    for scheduler, process in (*allocations, *interrupts):
        system = scheduler.enclosing(OperatingSystem) if scheduler is not None else None
        if system is not None and process is not None:
            yield system, process


RULE = ModelRule(
    id="INC-MAP-SHAREDRUN",
    title="runnable shared by several operating systems",
    severity=Severity.INFO,
    target=Runnable,
    check=_check,
    rationale="am2inc assigns the runnable to the first operating system only.",
    remedy="Use a separate runnable for each operating system, or expect the shared one in the first operating system.",
    fails="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </tasks>
  <tasks name="U">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </tasks>
  <runnables name="R"/>
</swModel>
<osModel>
  <operatingSystems name="A">
    <taskSchedulers name="S"/>
  </operatingSystems>
  <operatingSystems name="B">
    <taskSchedulers name="P"/>
  </operatingSystems>
</osModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
  <taskAllocation task="U?type=Task" scheduler="P?type=TaskScheduler"/>
</mappingModel>
""",
    edits={
        """  </operatingSystems>
  <operatingSystems name="B">
""": "",
    },
)
