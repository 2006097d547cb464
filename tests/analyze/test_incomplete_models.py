"""What a model leaves open stays open: an incomplete activity, stimulus or condition never makes a result better than it can be."""

import pytest
from support import MODEL

from amalthea_uros import analyze_system, extract, load
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.units import MICROSECOND as US

TEXT = """
<swModel>
  <tasks name="T" stimuli="{stimuli}"><activityGraph>{ticks}{items}</activityGraph></tasks>
  <runnables name="R">{condition}<activityGraph>{ticks}</activityGraph></runnables>
  <labels name="L"/>
  <modes xsi:type="am:EnumMode" name="M"><literals name="on"/></modes>
  <modeLabels name="mode" mode="M?type=EnumMode"/>
</swModel>
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="type"/>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"
      definition="type?type=ProcessingUnitDefinition"/>
  </structures>
  <domains xsi:type="am:FrequencyDomain" name="clock"><defaultValue value="1" unit="MHz"/></domains>
</hwModel>
<osModel>
  {overhead}
  <operatingSystems name="OS" overhead="costs?type=OsOverhead">
    <taskSchedulers name="S" definition="FPP?type=SchedulerDefinition"/>
  </operatingSystems>
  <schedulerDefinitions name="FPP" processParameters="priority?type=SchedulingParameterDefinition"/>
  <schedulingParameterDefinitions name="priority">
    <defaultValue xsi:type="am:IntegerObject" value="1"/>
  </schedulingParameterDefinitions>
  <semaphores name="lock"/>
</osModel>
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="usual"><recurrence value="10" unit="ms"/></stimuli>
  {more}
</stimuliModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
"""
TICKS = '<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="3"/></items>'
USUAL = {
    "ticks": TICKS,
    "items": "",
    "condition": "",
    "stimuli": "usual?type=PeriodicStimulus",
    "more": "",
    "overhead": '<osOverheads name="costs"/>',
}


def analyzed(tmp_path, memory=MemoryModel.NONE, **values):
    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format(TEXT.format(**USUAL | values)))
    extraction = extract(load(path))
    (task,) = analyze_system(extraction.system, Settings(memory=memory)).processes
    return task, [finding.rule for finding in extraction.findings]


def test_a_complete_model(tmp_path):
    task, findings = analyzed(tmp_path)
    assert (task.wcet, task.response.worst, findings) == (3 * US, 3 * US, [])


@pytest.mark.parametrize(
    "items",
    [
        '<items xsi:type="am:Ticks"/>',
        '<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant"/></items>',
        '<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueUniformDistribution" lowerBound="1"/></items>',
        # The greatest value of a histogram is unknown if an entry has no end.
        """<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueHistogram">
          <entries lowerBound="1" upperBound="2" occurrences="1"/><entries lowerBound="2" occurrences="1"/>
        </default></items>""",
        # The core has a value of its own, so that the default does not count; but it is not known.
        """<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="3"/>
          <extended key="type?type=ProcessingUnitDefinition"/></items>""",
        '<items xsi:type="am:ExecutionNeed"><needs key="Instructions"/></items>',
        '<items xsi:type="am:RunnableCall"/>',
        '<items xsi:type="am:RunnableCall" runnable="elsewhere?type=Runnable"/>',
        '<items xsi:type="am:SynchronousServerCall"/>',
        '<items xsi:type="am:WaitEvent"/>',
        '<items xsi:type="am:EnforcedMigration"/>',
        '<items xsi:type="am:SemaphoreAccess" access="request"/>',
        '<items xsi:type="am:SemaphoreAccess" semaphore="lock?type=Semaphore"/>',
        f'<items xsi:type="am:Group"><items xsi:type="am:RunnableCall"/>{TICKS}</items>',
    ],
)
def test_an_incomplete_activity_may_take_any_time(items, tmp_path):
    task, findings = analyzed(tmp_path, items=items)
    assert "EXT004" in findings
    assert task.response is None
    assert task.reason.startswith("it contains an incomplete ")


@pytest.mark.parametrize(
    "item", ['<items xsi:type="am:LabelAccess" access="read"/>', '<items xsi:type="am:SenderReceiverRead"/>']
)
def test_an_incomplete_access_takes_time_only_if_accesses_do(item, tmp_path):
    assert analyzed(tmp_path, items=item)[0].response.worst == 3 * US
    assert analyzed(tmp_path, items=item, memory=MemoryModel.EXPLICIT)[0].response is None


@pytest.mark.parametrize(
    "more",
    [
        '<stimuli xsi:type="am:PeriodicStimulus" name="X"/>',
        '<stimuli xsi:type="am:PeriodicStimulus" name="X"><recurrence value="10"/></stimuli>',
        """<stimuli xsi:type="am:PeriodicStimulus" name="X"><recurrence value="10" unit="ms"/>
          <jitter xsi:type="am:TimeUniformDistribution"><lowerBound value="0" unit="ms"/></jitter></stimuli>""",
        '<stimuli xsi:type="am:PeriodicStimulus" name="X"><offset value="1"/><recurrence value="10" unit="ms"/></stimuli>',
        """<stimuli xsi:type="am:PeriodicSyntheticStimulus" name="X"><recurrence value="10" unit="ms"/>
          <occurrenceTimes value="0" unit="ms"/><occurrenceTimes value="5"/></stimuli>""",
        '<stimuli xsi:type="am:RelativePeriodicStimulus" name="X"/>',
        """<stimuli xsi:type="am:EventStimulus" name="X" triggeringEvents="elsewhere?type=CustomEvent"/>""",
        # Not in the model at all.
        "",
    ],
)
def test_an_incomplete_stimulus_activates_at_an_unknown_rate(more, tmp_path):
    stimuli = f"usual?type=PeriodicStimulus X?type={more.split('am:')[1].split(chr(34))[0] if more else 'SingleStimulus'}"
    task, findings = analyzed(tmp_path, more=more, stimuli=stimuli)
    assert set(findings) & {"EXT003", "EXT004"}
    assert task.response is None
    assert "unbounded" in task.reason


UNREADABLE = '<entries xsi:type="am:ModeValueCondition" relation="EQUAL"/>'
LOCAL = '<entries xsi:type="am:LocalModeCondition" relation="EQUAL"/>'


@pytest.mark.parametrize(
    "entry", [UNREADABLE, LOCAL, f'<entries xsi:type="am:ConditionConjunction">{UNREADABLE}</entries>', ""]
)
def test_a_condition_that_is_not_stated_can_be_true_or_false(entry, tmp_path):
    long = TICKS.replace("3", "9")
    switch = f"""
    <items xsi:type="am:Switch">
      <entries name="first">{TICKS}<condition>{entry}</condition></entries>
      <defaultEntry>{long}</defaultEntry>
    </items>"""
    task, _ = analyzed(tmp_path, items=switch)
    assert (task.bcet, task.wcet) == (6 * US, 12 * US)
    call = '<items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>'
    task, _ = analyzed(tmp_path, items=call, condition=f"<executionCondition>{entry}</executionCondition>")
    assert (task.bcet, task.wcet) == (3 * US, 6 * US)


def test_an_overhead_without_a_value(tmp_path):
    point = '<items xsi:type="am:SchedulePoint"/>'
    overhead = '<osOverheads name="costs"><apiOverhead><apiSchedule/></apiOverhead></osOverheads>'
    task, findings = analyzed(tmp_path, items=point, overhead=overhead)
    assert "EXT004" in findings
    assert task.reason == "ticks have no value for the core 'core'"
