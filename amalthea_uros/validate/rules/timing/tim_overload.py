"""Processing unit with more to do than it can."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnit
from amalthea_uros.units import number_text
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.load import loads
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.wording import joined


def _check(element: ProcessingUnit, context: Context) -> Iterator[str]:
    shares = loads(context).get(element, {})
    total = sum(shares.values())
    if total > 1:
        greatest = sorted(shares.items(), key=lambda item: item[1], reverse=True)
        parts = joined(f"{_percent(share)} by {process.name!r}" for process, share in greatest)
        yield f"the load of {element.name!r} is {_percent(total)} in the worst case: {parts}"


def _percent(share: Fraction | int) -> str:
    # Rounded up, so that more than all of it never looks like all of it.
    return f"{number_text(Fraction(ceil(share * 100_000), 1000))} %"


RULE = ModelRule(
    id="TIM-OVERLOAD",
    title="processing unit with more to do than it can",
    severity=Severity.WARNING,
    target=ProcessingUnit,
    check=_check,
    rationale="If every job takes its worst case, work piles up without an end: the response times of the least urgent processes have "
    "no bound, nor have the latencies of what goes through them.",
    remedy="Shorten execution times, lengthen periods, move processes to other processing units, or take a faster one.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="1" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
</hwModel>
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
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
    passes="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="1" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
</hwModel>
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="P">
    <recurrence value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="P?type=PeriodicStimulus">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1000"/>
      </items>
    </activityGraph>
  </tasks>
</swModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
)
