"""Deadline behind the next activation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    LimitType,
    Process,
    ProcessRequirement,
    TaskAllocation,
    Time,
    TimeMetric,
    TimeRequirementLimit,
)
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.units import time_text
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.load import rates
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import deciding, parameter


def _check(element: Process, context: Context) -> Iterator[str]:
    deadline, rate = context.once(_deadlines).get(element), rates(context).get(element)
    if deadline is not None and rate and deadline * rate > 1:
        often = time_text(1 / rate)
        yield f"{element.name!r} has {time_text(deadline)} to respond, and is activated as often as every {often}"


def _deadlines(context: Context) -> dict[Process, int]:
    """The shortest deadline of each process, in picoseconds."""
    found: dict[Process, int] = {}
    for process, time in (*_required(context), *_scheduled(context)):
        deadline = picoseconds(time)
        if deadline is not None:
            found[process] = min(deadline, found.get(process, deadline))
    return found


def _required(context: Context) -> Iterator[tuple[Process, Time | None]]:
    for requirement in context.all(ProcessRequirement):
        match requirement.limit:
            case TimeRequirementLimit(limit_type=LimitType.UPPER_LIMIT, metric=TimeMetric.RESPONSE_TIME, limit_value=time):
                if isinstance(requirement.process, Process):
                    yield requirement.process, time


def _scheduled(context: Context) -> Iterator[tuple[Process, Time | None]]:
    for allocation in context.all(TaskAllocation):
        value = parameter(allocation, "deadline", deciding(allocation.scheduler))
        if allocation.task is not None and isinstance(value, Time):
            yield allocation.task, value


RULE = ModelRule(
    id="TIM-DEADLINE",
    title="deadline behind the next activation",
    severity=Severity.INFO,
    target=Process,
    check=_check,
    rationale="Several jobs of it may be there at a time. Its response times then contain waiting for its own earlier jobs, and "
    "where it may not be activated again while it runs, activations are lost instead.",
    remedy="Shorten the deadline if only one job at a time is meant; else see that the activation limit allows for several.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="P">
    <recurrence value="10" unit="ms"/>
  </stimuli>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="P?type=PeriodicStimulus"/>
</swModel>
<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="R" process="T?type=Task">
    <limit xsi:type="am:TimeRequirementLimit" limitType="UpperLimit" metric="ResponseTime">
      <limitValue value="11" unit="ms"/>
    </limit>
  </requirements>
</constraintsModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="P">
    <recurrence value="10" unit="ms"/>
  </stimuli>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="P?type=PeriodicStimulus"/>
</swModel>
<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="R" process="T?type=Task">
    <limit xsi:type="am:TimeRequirementLimit" limitType="UpperLimit" metric="ResponseTime">
      <limitValue value="10" unit="ms"/>
    </limit>
  </requirements>
</constraintsModel>
""",
)
