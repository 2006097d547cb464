"""Deadline behind the next activation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.timing.activation.releases import response_time_limits
from amalthea_uros.units import Time, time_text
from amalthea_uros.validate.rule import SystemProblem, SystemRule
from amalthea_uros.validate.system_context import SystemContext


def _check(context: SystemContext) -> Iterator[SystemProblem]:
    for name, deadline in _deadlines(context).items():
        process, rate = context.system.processes.get(name), context.rates.get(name)
        if process is not None and rate and deadline * rate > 1:
            message = (
                f"the deadline of {name!r} is {time_text(deadline)}, longer than the {time_text(1 / rate)} between activations"
            )
            yield SystemProblem(process, message)


def _deadlines(context: SystemContext) -> dict[str, Time]:
    """The shortest deadline of each process, by requirements and by its scheduler."""
    found = response_time_limits(context.system)
    for allocation in context.system.mapping.tasks:
        if allocation.deadline is not None:
            found[allocation.task] = min(allocation.deadline, found.get(allocation.task, allocation.deadline))
    return found


RULE = SystemRule(
    id="TIM-DEADLINE",
    title="deadline later than the next activation",
    severity=Severity.INFO,
    check=_check,
    rationale="Several jobs may be pending at the same time. Its response times then include waiting for its own earlier jobs; if the "
    "activation limit does not allow that, activations are lost.",
    remedy="Shorten the deadline if only one job may be pending; otherwise raise the activation limit.",
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
    edits={'value="11"': 'value="10"'},
)
