"""Missing deadline of an EDF task."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AbstractProcess,
    LimitType,
    ProcessRequirement,
    Task,
    TaskAllocation,
    TimeMetric,
    TimeRequirementLimit,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import policy


def _check(element: Task, context: Context) -> Iterator[str]:
    if element in context.once(_by_deadline) and element not in context.once(_limited):
        yield f"{element.name!r} is scheduled by EDF, but no requirement limits its response time"


def _by_deadline(context: Context) -> set[Task]:
    allocations = context.all(TaskAllocation)
    return {
        allocation.task
        for allocation in allocations
        if allocation.task is not None and policy(allocation.scheduler) == "EarliestDeadlineFirst"
    }


def _limited(context: Context) -> set[AbstractProcess]:
    # Deadlines in scheduling parameters do not count: APP4MC's rule is older than these parameters.
    return {
        requirement.process
        for requirement in context.all(ProcessRequirement)
        if requirement.process is not None
        and isinstance(requirement.limit, TimeRequirementLimit)
        and requirement.limit.limit_type is LimitType.UPPER_LIMIT
        and requirement.limit.metric is TimeMetric.RESPONSE_TIME
    }


RULE = ModelRule(
    id="TA-Constraints-EDFTaskMustHaveDeadline",
    title="missing deadline of an EDF task",
    severity=Severity.ERROR,
    target=Task,
    check=_check,
    rationale="Without a deadline, the scheduling order of the task is undefined. APP4MC's validation also reports it.",
    remedy="Add a requirement with an upper limit for the response time of the task.",
    fails="""
<osModel>
  <schedulerDefinitions name="EarliestDeadlineFirst"/>
  <operatingSystems name="OS">
    <taskSchedulers name="S" definition="EarliestDeadlineFirst?type=SchedulerDefinition"/>
  </operatingSystems>
</osModel>
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
    edits={
        "<mappingModel>": """<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="deadline" process="T?type=Task">
    <limit xsi:type="am:TimeRequirementLimit" limitType="UpperLimit" metric="ResponseTime">
      <limitValue value="10" unit="ms"/>
    </limit>
  </requirements>
</constraintsModel>
<mappingModel>""",
    },
)
