"""Processing unit with more to do than it can."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil

from amalthea_uros.diagnostics import Severity
from amalthea_uros.units import number_text
from amalthea_uros.validate.examples import SCHEDULER
from amalthea_uros.validate.rule import SystemProblem, SystemRule
from amalthea_uros.validate.system_context import SystemContext
from amalthea_uros.validate.wording import joined


def _check(context: SystemContext) -> Iterator[SystemProblem]:
    for core, total in context.certain_loads.items():
        if total > 1:
            largest = sorted(context.loads.get(core, {}).items(), key=lambda item: item[1], reverse=True)
            parts = joined(f"{_percent(share)} by {process!r}" for process, share in largest)
            yield SystemProblem(
                context.system.cores[core], f"overload: the worst-case load of {core!r} is {_percent(total)}: {parts}"
            )


def _percent(share: Fraction | int) -> str:
    # Rounded up, so that an overload never looks like 100 %.
    return f"{number_text(Fraction(ceil(share * 100_000), 1000))} %"


RULE = SystemRule(
    id="TIM-OVERLOAD",
    title="overloaded processing unit",
    severity=Severity.ERROR,
    check=_check,
    rationale="If every job takes its worst-case execution time, more work is activated than the processing unit can execute: the "
    "response times of processes of low priority, and the latencies of chains through them, have no upper bound.",
    remedy="Shorten execution times, lengthen periods, move processes to other processing units, or use a faster one.",
    fails=f"""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="1" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
</hwModel>
{SCHEDULER}
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="P">
    <recurrence value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="P?type=PeriodicStimulus">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1001"/>
      </items>
    </activityGraph>
  </tasks>
</swModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
    edits={'value="1001"': 'value="1000"'},
)
