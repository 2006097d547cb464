"""What a model leaves open, or states without a meaning, stays open: it never makes a result better than it can be, and never fails."""

from fractions import Fraction

import pytest
from support import MODEL

from amalthea_uros import analyze_system, extract, load
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.validate.system_context import SystemContext

TEXT = """
<swModel>
  <tasks name="T" stimuli="{stimuli}"><activityGraph>{ticks}{items}</activityGraph></tasks>
  <runnables name="R">{condition}<activityGraph>{ticks}</activityGraph></runnables>
  {runnables}
  <labels name="L"/>
  <modes xsi:type="am:EnumMode" name="M"><literals name="on"/></modes>
  <modeLabels name="mode" mode="M?type=EnumMode"/>
</swModel>
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="type"/>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core" {domain}
      definition="type?type=ProcessingUnitDefinition"/>
  </structures>
  <domains xsi:type="am:FrequencyDomain" name="clock"><defaultValue value="{frequency}" unit="MHz"/></domains>
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
  <stimuli xsi:type="am:InterProcessStimulus" name="triggered"/>
  <stimuli xsi:type="am:CustomStimulus" name="custom"/>
  {more}
</stimuliModel>
<eventModel>
  <events xsi:type="am:ProcessEvent" name="start" eventType="start" entity="T?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="end" eventType="terminate" entity="T?type=Task"/>
</eventModel>
<constraintsModel>
  <eventChains name="C" stimulus="start?type=ProcessEvent" response="end?type=ProcessEvent"/>
</constraintsModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
</mappingModel>
"""
CONSTANT = '<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="{}"/></items>'
TICKS = CONSTANT.format(3)
PERIODIC = "usual?type=PeriodicStimulus"
USUAL = {
    "ticks": TICKS,
    "items": "",
    "condition": "",
    "runnables": "",
    "stimuli": PERIODIC,
    "more": "",
    "overhead": '<osOverheads name="costs"/>',
    "domain": 'frequencyDomain="clock?type=FrequencyDomain"',
    "frequency": "1",
}


@pytest.fixture
def extracted(tmp_path):
    def of(**values):
        path = tmp_path / "model.amxmi"
        path.write_text(MODEL.format(TEXT.format(**USUAL | values)))
        return extract(load(path))

    return of


@pytest.fixture
def analyzed(extracted):
    """The task, and the rules of what was found while reading; a core on which something is unknown has no certain load of it."""

    def of(memory=MemoryModel.NONE, **values):
        extraction = extracted(**values)
        (task,) = analyze_system(extraction.system, Settings(memory=memory)).processes
        if task.response is None and memory is MemoryModel.NONE:
            assert not any(SystemContext(extraction.system).certain_loads.values())
        return task, [finding.rule for finding in extraction.findings]

    return of


def call(name):
    return f'<items xsi:type="am:RunnableCall" runnable="{name}?type=Runnable"/>'


def runnable(name, *called):
    return f'<runnables name="{name}"><activityGraph>{TICKS}{"".join(map(call, called))}</activityGraph></runnables>'


def test_a_complete_model(analyzed, extracted):
    task, findings = analyzed()
    assert (task.wcet, task.response.worst, findings) == (3 * US, 3 * US, [])
    assert SystemContext(extracted().system).certain_loads == {"core": Fraction(3, 10_000)}


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
def test_an_incomplete_activity_may_take_any_time(items, analyzed):
    task, findings = analyzed(items=items)
    assert "EXT004" in findings
    assert task.response is None
    assert task.reason.startswith("it contains an incomplete ")


@pytest.mark.parametrize(
    "item", ['<items xsi:type="am:LabelAccess" access="read"/>', '<items xsi:type="am:SenderReceiverRead"/>']
)
def test_an_incomplete_access_takes_time_only_if_accesses_do(item, analyzed):
    assert analyzed(items=item)[0].response.worst == 3 * US
    assert analyzed(items=item, memory=MemoryModel.EXPLICIT)[0].response is None


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
def test_an_incomplete_stimulus_activates_at_an_unknown_rate(more, analyzed):
    stimuli = f"{PERIODIC} X?type={more.split('am:')[1].split(chr(34))[0] if more else 'SingleStimulus'}"
    task, findings = analyzed(more=more, stimuli=stimuli)
    assert set(findings) & {"EXT003", "EXT004"}
    assert task.response is None
    assert "unbounded" in task.reason


UNREADABLE = '<entries xsi:type="am:ModeValueCondition" relation="EQUAL"/>'
LOCAL = '<entries xsi:type="am:LocalModeCondition" relation="EQUAL"/>'


@pytest.mark.parametrize(
    "entry", [UNREADABLE, LOCAL, f'<entries xsi:type="am:ConditionConjunction">{UNREADABLE}</entries>', ""]
)
def test_a_condition_that_is_not_stated_can_be_true_or_false(entry, analyzed):
    long = TICKS.replace("3", "9")
    switch = f"""
    <items xsi:type="am:Switch">
      <entries name="first">{TICKS}<condition>{entry}</condition></entries>
      <defaultEntry>{long}</defaultEntry>
    </items>"""
    task, _ = analyzed(items=switch)
    assert (task.bcet, task.wcet) == (6 * US, 12 * US)
    task, _ = analyzed(items=call("R"), condition=f"<executionCondition>{entry}</executionCondition>")
    assert (task.bcet, task.wcet) == (3 * US, 6 * US)


def test_an_overhead_without_a_value(analyzed):
    overhead = '<osOverheads name="costs"><apiOverhead><apiSchedule/></apiOverhead></osOverheads>'
    task, findings = analyzed(items='<items xsi:type="am:SchedulePoint"/>', overhead=overhead)
    assert "EXT004" in findings
    assert task.reason == "ticks have no value for the core 'core'"


DISTRIBUTED = '<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValue{}"/></items>'
STATISTICS = DISTRIBUTED.format('Statistics" lowerBound="{}" upperBound="3" average="2.0')
COUNTED = '<items xsi:type="am:RunnableCall" runnable="R?type=Runnable"><counter prescaler="{}"/></items>'
HUGE = "99999999999999999999"


def jittering(period, early):
    """A stimulus of its own, whose jitter is between two numbers of milliseconds."""
    stimulus = f"""<stimuli xsi:type="am:PeriodicStimulus" name="X"><recurrence value="{period}" unit="ms"/>
      <jitter xsi:type="am:TimeUniformDistribution">
        <lowerBound value="{early}" unit="ms"/><upperBound value="1" unit="ms"/>
      </jitter></stimuli>"""
    return {"more": stimulus, "stimuli": "X?type=PeriodicStimulus"}


@pytest.mark.parametrize(
    "values",
    [
        pytest.param({"items": f'<items xsi:type="am:WhileLoop">{TICKS}</items>'}, id="loop"),
        pytest.param(
            {
                "items": """<items xsi:type="am:ExecutionNeed"><needs key="X">
                  <value xsi:type="am:DiscreteValueConstant" value="1"/></needs></items>"""
            },
            id="need",
        ),
        pytest.param({"items": call("A"), "runnables": runnable("A", "B") + runnable("B", "A")}, id="circle"),
        pytest.param({"items": call("A"), "runnables": runnable("A", "A")}, id="itself"),
        pytest.param({"ticks": DISTRIBUTED.format('GaussDistribution" mean="1')}, id="no bound"),
        pytest.param({"stimuli": ""}, id="no stimulus"),
        pytest.param({"stimuli": "triggered?type=InterProcessStimulus"}, id="never triggered"),
        pytest.param({"stimuli": "custom?type=CustomStimulus"}, id="custom"),
        # What is known of one stimulus is not all.
        pytest.param({"stimuli": f"{PERIODIC} custom?type=CustomStimulus"}, id="partly custom"),
        pytest.param({"domain": ""}, id="no clock"),
        # What every zeroth time means is not known.
        *(pytest.param({"items": COUNTED.format(value)}, id=f"prescaler {value}") for value in ("0", "-2")),
        # What a negative time means is not known, nor which of two bounds in the wrong order is right.
        pytest.param({"ticks": CONSTANT.format("-3")}, id="negative ticks"),
        pytest.param({"ticks": STATISTICS.format("-1")}, id="a negative bound"),
        pytest.param({"ticks": STATISTICS.format(HUGE)}, id="bounds in the wrong order"),
        # What is beyond days is beyond counting.
        pytest.param({"ticks": CONSTANT.format(HUGE)}, id="huge ticks"),
        *(
            pytest.param(jittering(period, early), id=f"period {period}, jitter from {early}")
            for period, early in ((HUGE, "0"), ("10", f"-{HUGE}"), ("10", HUGE))
        ),
        # Neither can a clock run backwards, nor a core take a negative time for an instruction.
        *(pytest.param({"frequency": value}, id=f"frequency {value}") for value in ("-1", "0")),
    ],
)
def test_what_is_not_known_or_makes_no_sense_is_unknown(values, analyzed):
    task, _ = analyzed(**values)
    assert task.response is None
    assert task.reason


@pytest.mark.parametrize("alpha", ["NaN", "Infinity"])
def test_the_bounds_of_a_distribution_whose_mean_is_not_known_count(alpha, analyzed):
    beta = f'BetaDistribution" lowerBound="1" upperBound="3" alpha="{alpha}" beta="1.0'
    assert analyzed(ticks=DISTRIBUTED.format(beta))[0].response.worst == 3 * US


def test_a_jitter_that_is_known_is_no_obstacle(analyzed):
    assert analyzed(**jittering("10", "0"))[0].response.worst == 3 * US


def test_a_task_that_triggers_itself_has_no_rate(extracted):
    trigger = '<items xsi:type="am:InterProcessTrigger" stimulus="triggered?type=InterProcessStimulus"/>'
    extraction = extracted(items=trigger, stimuli=f"{PERIODIC} triggered?type=InterProcessStimulus")
    assert not SystemContext(extraction.system).rates


def test_calls_may_be_nested_deeper_than_recursion_goes(extracted):
    depth = 3000
    chained = runnable(f"A{depth}") + "".join(runnable(f"A{number}", f"A{number + 1}") for number in range(depth))
    # The task itself and each runnable take 3 us of 10 ms.
    loads = SystemContext(extracted(items=call("A0"), runnables=chained).system).certain_loads
    assert loads == {"core": (depth + 2) * Fraction(3, 10_000)}


def test_runnables_that_many_call_are_looked_at_once(extracted):
    # Each calls the next one twice: 2^200 executions.
    doubled = runnable("A200") + "".join(runnable(f"A{number}", *[f"A{number + 1}"] * 2) for number in range(200))
    loads = SystemContext(extracted(items=call("A0"), runnables=doubled).system).certain_loads
    assert loads == {"core": 2**201 * Fraction(3, 10_000)}
