"""Invalid and extreme values: the analysis reports unknown results and never fails."""

import pytest
from support import MODEL

from amalthea_uros import analyze_system, extract, load
from amalthea_uros.units import MICROSECOND

TEXT = """
<swModel>
  <tasks name="T" stimuli="S?type=PeriodicStimulus">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"><counter prescaler="{prescaler}"/></items>
    </activityGraph>
  </tasks>
  <tasks name="U" stimuli="S?type=PeriodicStimulus">
    <activityGraph><items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/></activityGraph>
  </tasks>
  <runnables name="R"><activityGraph><items xsi:type="am:Ticks"><default {ticks}/></items></activityGraph></runnables>
</swModel>
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
  <domains xsi:type="am:FrequencyDomain" name="clock"><defaultValue value="{frequency}" unit="MHz"/></domains>
</hwModel>
<osModel>
  <operatingSystems name="OS"><taskSchedulers name="O" definition="FPP?type=SchedulerDefinition"/></operatingSystems>
  <schedulerDefinitions name="FPP" processParameters="priority?type=SchedulingParameterDefinition"/>
  <schedulingParameterDefinitions name="priority">
    <defaultValue xsi:type="am:IntegerObject" value="1"/>
  </schedulingParameterDefinitions>
</osModel>
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="{period}" unit="ms"/>
    <jitter xsi:type="am:TimeUniformDistribution"><lowerBound value="{early}" unit="ms"/><upperBound value="1" unit="ms"/></jitter>
  </stimuli>
</stimuliModel>
<eventModel>
  <events xsi:type="am:ProcessEvent" name="start" eventType="start" entity="T?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="end" eventType="terminate" entity="U?type=Task"/>
</eventModel>
<constraintsModel>
  <eventChains name="C" stimulus="start?type=ProcessEvent" response="end?type=ProcessEvent"/>
</constraintsModel>
<mappingModel>
  <schedulerAllocation scheduler="O?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="O?type=TaskScheduler"/>
  <taskAllocation task="U?type=Task" scheduler="O?type=TaskScheduler"/>
</mappingModel>
"""

CONSTANT = 'xsi:type="am:DiscreteValueConstant" value="{}"'
BETA = 'xsi:type="am:DiscreteValueBetaDistribution" lowerBound="1" upperBound="3" alpha="{}" beta="1.0"'
STATISTICS = 'xsi:type="am:DiscreteValueStatistics" lowerBound="{}" upperBound="3" average="2.0"'
HUGE = "99999999999999999999"


@pytest.mark.parametrize(
    ("values", "worst"),
    [
        ({}, 3),
        # What every zeroth time means is not known.
        ({"prescaler": "0"}, None),
        ({"prescaler": "-2"}, None),
        # What a negative time means is not known, nor which of two bounds in the wrong order is right.
        ({"ticks": CONSTANT.format("-3")}, None),
        ({"ticks": STATISTICS.format("-1")}, None),
        ({"ticks": STATISTICS.format(HUGE)}, None),
        # The mean of a distribution whose parameters are no numbers is not known, but its bounds are.
        ({"ticks": BETA.format("NaN")}, 3),
        ({"ticks": BETA.format("Infinity")}, 3),
        # What is beyond days is beyond counting.
        ({"ticks": CONSTANT.format(HUGE)}, None),
        ({"period": HUGE}, None),
        ({"early": f"-{HUGE}"}, None),
        ({"early": HUGE}, None),
        # Neither can a clock run backwards, nor a core take a negative time for an instruction.
        ({"frequency": "-1"}, None),
        ({"frequency": "0"}, None),
    ],
)
def test_a_value_that_makes_no_sense(values, worst, tmp_path):
    path = tmp_path / "model.amxmi"
    usual = {"prescaler": "1", "ticks": CONSTANT.format("3"), "period": "10", "early": "0", "frequency": "1"}
    path.write_text(MODEL.format(TEXT.format(**usual | values)))
    analysis = analyze_system(extract(load(path)).system)
    (task, _) = analysis.processes
    if worst is None:
        assert task.response is None
        assert task.reason
    else:
        assert task.wcet == worst * MICROSECOND
        # The other task of the same priority comes first, counted from the activation; a window is 1 ps at least.
        assert task.response.worst == max(1, 2 * worst * MICROSECOND)
