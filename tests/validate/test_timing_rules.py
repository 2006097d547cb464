"""The rules of the timing profile beyond their examples."""

import pytest
from effort import every
from excerpts import access, call, found, graph, model, runnable
from growth import growth
from support import corpus, hand_written

from amalthea_uros import check, extract, load
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.activities import AccessKind, LabelAccess
from amalthea_uros.timing.dataflow.links import Dataflow

TICK = '<items t="Ticks"><default t="DiscreteValueConstant" value="100"/></items>'


# Priorities


def prioritized(priority):
    if priority is None:
        return ""
    value = f'<value t="IntegerObject" value="{priority}"/>'
    return f'<schedulingParameters key="priority?type=SchedulingParameterDefinition">{value}</schedulingParameters>'


def scheduled(definition="FixedPriorityPreemptive", tasks=(("T", 1),), processes="", parent="", default=None, affinity=""):
    """Tasks of (name, priority or None) on one scheduler of two cores."""

    allocations = "".join(
        f'<taskAllocation task="{name}?type=Task" scheduler="S?type=TaskScheduler" {affinity}>{prioritized(priority)}</taskAllocation>'
        for name, priority in tasks
    )
    given = "" if default is None else f'<defaultValue t="IntegerObject" value="{default}"/>'
    return f"""
<hwModel>
  <structures name="ECU">
    <modules t="ProcessingUnit" name="core0"/><modules t="ProcessingUnit" name="core1"/>
  </structures>
</hwModel>
<osModel>
  <schedulingParameterDefinitions name="priority">{given}</schedulingParameterDefinitions>
  <schedulerDefinitions name="{definition}" processParameters="priority?type=SchedulingParameterDefinition"/>
  <schedulerDefinitions name="OSEK"/>
  <operatingSystems name="OS">
    <taskSchedulers name="S" definition="{definition}?type=SchedulerDefinition">{parent}</taskSchedulers>
    <taskSchedulers name="P" definition="OSEK?type=SchedulerDefinition"/>
  </operatingSystems>
</osModel>
<swModel>{"".join(f'<tasks name="{name}"/>' for name in dict.fromkeys(name for name, _ in tasks))}{processes}</swModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core0?type=ProcessingUnit core1?type=ProcessingUnit"/>
  {allocations}
</mappingModel>"""


@pytest.mark.parametrize(
    ("definition", "is_needed"),
    [
        ("FixedPriorityPreemptive", True),
        ("OSEK_", False),
        ("fpp", True),
        ("PriorityBasedRoundRobin", True),
        ("FixedPriorityPreemptiveWithBudgetEnforcement", True),
        ("EarliestDeadlineFirst", False),
        ("Grouping", False),
    ],
)
def test_priorities_are_needed_where_they_decide(definition, is_needed, tmp_path):
    assert bool(found("TIM-PRIORITY", scheduled(definition, [("T", None)]), tmp_path)) is is_needed


def test_a_priority_by_default(tmp_path):
    assert found("TIM-PRIORITY", scheduled(tasks=[("T", None)], default=3), tmp_path) == []


def test_priorities_below_a_grouping(tmp_path):
    # The parent of a grouping decides, by the priority of the task, or by that of the whole group.
    parent = '<parentAssociation parent="P?type=TaskScheduler">{}</parentAssociation>'
    for inner, expected in (("", ["task 'T' has no priority"]), (prioritized(1), [])):
        excerpt = scheduled("Grouping", [("T", None)], parent=parent.format(inner))
        assert found("TIM-PRIORITY", excerpt, tmp_path) == expected


def test_a_grouping_above_itself(tmp_path):
    parent = '<parentAssociation parent="S?type=TaskScheduler"/>'
    assert found("TIM-PRIORITY", scheduled("Grouping", [("T", None)], parent=parent), tmp_path) == []


@pytest.mark.parametrize(
    ("definition", "tasks", "expected"),
    [
        (
            "FixedPriorityPreemptive",
            [("T", 1), ("U", 1)],
            ["'T' has the priority 1, as 'U' has", "'U' has the priority 1, as 'T' has"],
        ),
        ("FixedPriorityPreemptive", [("T", 1), ("U", 2)], []),
        ("FixedPriorityPreemptive", [("T", None), ("U", None)], []),
        # A task does not wait for itself.
        ("FixedPriorityPreemptive", [("T", 1), ("T", 1)], []),
        # Priorities that do not decide, or that are meant to be shared.
        ("EarliestDeadlineFirst", [("T", 1), ("U", 1)], []),
        ("PriorityBasedRoundRobin", [("T", 1), ("U", 1)], []),
    ],
)
def test_shared_priorities(definition, tasks, expected, tmp_path):
    assert found("TIM-PRIORITY-SHARED", scheduled(definition, tasks), tmp_path) == expected


def test_many_that_share_a_priority(tmp_path):
    (first, *_) = found("TIM-PRIORITY-SHARED", scheduled(tasks=[(f"T{number}", 1) for number in range(8)]), tmp_path)
    assert first == "'T0' has the priority 1, as 'T1', 'T2', 'T3', 'T4', 'T5' and 2 more have"


def test_tasks_on_different_cores_share_no_priority(tmp_path):
    tasks = [("T", 1), ("U", 1)]
    assert len(found("TIM-PRIORITY-SHARED", scheduled(tasks=tasks), tmp_path)) == 2
    one, two = 'affinity="core0?type=ProcessingUnit"', 'affinity="core1?type=ProcessingUnit"'
    here, there = scheduled(tasks=tasks, affinity=one).rsplit(one, 1)
    assert found("TIM-PRIORITY-SHARED", here + two + there, tmp_path) == []


def test_priorities_until_1_2(tmp_path):
    def excerpt(first, second):
        return f"""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"><schedulingAlgorithm t="OSEK"/></taskSchedulers>
  </operatingSystems>
</osModel>
<swModel><tasks name="T"/><tasks name="U"/></swModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler">{first}</taskAllocation>
  <taskAllocation task="U?type=Task" scheduler="S?type=TaskScheduler">{second}</taskAllocation>
</mappingModel>"""

    one = '<schedulingParameters priority="1"/>'
    assert found("TIM-PRIORITY", excerpt(one, ""), tmp_path, "1.2.0") == ["task 'U' has no priority"]
    assert len(found("TIM-PRIORITY-SHARED", excerpt(one, one), tmp_path, "1.2.0")) == 2


@pytest.mark.parametrize(("algorithm", "is_told"), [('<schedulingAlgorithm t="OSEK"/>', False), ("", True)])
def test_policies_until_1_2(algorithm, is_told, tmp_path):
    excerpt = f"""
<osModel><operatingSystems name="OS"><taskSchedulers name="S">{algorithm}</taskSchedulers></operatingSystems></osModel>
<mappingModel><taskAllocation scheduler="S?type=TaskScheduler"/></mappingModel>"""
    assert bool(found("TIM-POLICY", excerpt, tmp_path, "1.2.0")) is is_told


def test_a_scheduler_without_tasks_needs_no_policy(tmp_path):
    excerpt = '<osModel><operatingSystems name="OS"><taskSchedulers name="S"/></operatingSystems></osModel>'
    assert found("TIM-POLICY", excerpt, tmp_path) == []


# Places


NOWHERE = [f"'{name}' is not allocated to a scheduler or an interrupt controller" for name in "IT"]


@pytest.mark.parametrize(
    ("allocations", "expected"),
    [
        ("", NOWHERE),
        ('<taskAllocation task="T?type=Task"/><isrAllocation isr="I?type=ISR"/>', NOWHERE),
        (
            '<taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>'
            '<taskAllocation task="T?type=Task" scheduler="R?type=TaskScheduler"/>'
            '<isrAllocation isr="I?type=ISR" controller="C?type=InterruptController"/>',
            ["'T' is allocated 2 times"],
        ),
    ],
)
def test_places(allocations, expected, tmp_path):
    excerpt = f"""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/><taskSchedulers name="R"/><interruptControllers name="C"/>
  </operatingSystems>
</osModel>
<swModel><tasks name="T"/><isrs name="I"/><processPrototypes name="P"/></swModel>
<mappingModel>{allocations}</mappingModel>"""
    assert sorted(found("TIM-ALLOCATION", excerpt, tmp_path)) == expected


@pytest.mark.parametrize(
    ("value", "is_known"),
    [
        ('value="1" unit="MHz"', True),
        ('value="1"', False),
        ('value="1" unit="_undefined_"', False),
        ('value="0" unit="MHz"', False),
        ('value="Infinity" unit="MHz"', False),
    ],
)
def test_clocks(value, is_known, tmp_path):
    excerpt = f"""
<hwModel>
  <domains t="FrequencyDomain" name="clock"><defaultValue {value}/></domains>
  <structures name="ECU">
    <modules t="ProcessingUnit" name="core" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
</hwModel>"""
    assert found("TIM-CLOCK", excerpt, tmp_path) == ([] if is_known else ["the clock frequency of 'core' is unknown"])


# Activations

STIMULUS = '<stimuliModel><stimuli t="{}" name="S" {}>{}</stimuli></stimuliModel>'


def ms(tag, value):
    return f'<{tag} value="{value}" unit="ms"/>'


def jitters(kind, content):
    return f'{ms("recurrence", 1)}<jitter t="{kind}">{content}</jitter>'


def curve(number, border, value):
    """An entry of an arrival curve."""
    return f'<entries numberOfOccurrences="{number}">{ms(border, value)}</entries>'


NEXT = '<nextOccurrence t="TimeBoundaries">{}</nextOccurrence>'
FIVE_PER_STEP = '<occurrencesPerStep t="ContinuousValueConstant" value="5"/>'


@pytest.mark.parametrize(
    ("kind", "parts", "is_told"),
    [
        ("PeriodicStimulus", ms("recurrence", 1), False),
        ("PeriodicStimulus", ms("recurrence", 0), True),
        ("PeriodicStimulus", ms("recurrence", -1), True),
        ("PeriodicStimulus", '<recurrence value="1"/>', True),
        ("PeriodicStimulus", '<recurrence value="1" unit="_undefined_"/>', True),
        ("PeriodicStimulus", jitters("TimeGaussDistribution", ms("mean", 0)), True),
        ("PeriodicStimulus", jitters("TimeConstant", ms("value", 0)), False),
        ("PeriodicSyntheticStimulus", "", True),
        ("PeriodicBurstStimulus", "", True),
        ("RelativePeriodicStimulus", "", True),
        ("RelativePeriodicStimulus", NEXT.format(ms("lowerBound", 1)), False),
        ("RelativePeriodicStimulus", NEXT.format(ms("upperBound", 1)), True),
        ("ArrivalCurveStimulus", "", True),
        ("ArrivalCurveStimulus", curve(2, "lowerTimeBorder", 1), False),
        ("ArrivalCurveStimulus", curve(2, "upperTimeBorder", 1), True),
        # A single occurrence takes no time.
        ("ArrivalCurveStimulus", curve(1, "lowerTimeBorder", 1), True),
        ("VariableRateStimulus", ms("step", 1000) + FIVE_PER_STEP, False),
        ("VariableRateStimulus", FIVE_PER_STEP, True),
        ("VariableRateStimulus", ms("step", 1000), True),
        # A clock drives it.
        ("VariableRateStimulus", "<scenario/>", False),
        ("CustomStimulus", "", True),
        ("SingleStimulus", "", False),
        ("InterProcessStimulus", "", False),
        ("EventStimulus", "", False),
    ],
)
def test_distances_of_occurrences(kind, parts, is_told, tmp_path):
    assert bool(found("TIM-PERIOD", STIMULUS.format(kind, "", parts), tmp_path)) is is_told


TRIGGER = '<items t="InterProcessTrigger" stimulus="I?type=InterProcessStimulus"/>'


@pytest.mark.parametrize(
    ("stimuli", "others", "expected"),
    [
        ("", "", ["'T' is never activated: it has no stimulus"]),
        ("I?type=InterProcessStimulus", "", ["'T' is never activated: nothing triggers 'I'"]),
        (
            "I?type=InterProcessStimulus",
            f'<isrs name="J">{graph(TRIGGER)}</isrs>',
            ["'J' is never activated: it has no stimulus"],
        ),
        # The runnable is not executed.
        ("I?type=InterProcessStimulus", runnable("R", TRIGGER), ["'T' is never activated: nothing triggers 'I'"]),
        ("E?type=EventStimulus", "", ["'T' is never activated: nothing triggers 'E'"]),
        ("I?type=InterProcessStimulus C?type=CustomStimulus", "", []),
        ("elsewhere?type=InterProcessStimulus", "", []),
    ],
)
def test_stimuli_that_never_occur(stimuli, others, expected, tmp_path):
    excerpt = f"""
<stimuliModel>
  <stimuli t="InterProcessStimulus" name="I"/>
  <stimuli t="EventStimulus" name="E"/>
  <stimuli t="CustomStimulus" name="C"/>
</stimuliModel>
<swModel><tasks name="T" stimuli="{stimuli}"/>{others}</swModel>"""
    assert found("TIM-STIMULUS", excerpt, tmp_path) == expected


RECURRENCE = ms("recurrence", 10)
BURST = RECURRENCE + ms("burstLength", 1)
OF_FOUR = 'occurrenceCount="4"'


def at(*times):
    return "".join(ms("occurrenceTimes", time) for time in times)


@pytest.mark.parametrize(
    ("kind", "attributes", "parts", "at_once"),
    [
        ("PeriodicBurstStimulus", OF_FOUR, BURST, 4),
        ("PeriodicBurstStimulus", OF_FOUR, BURST + ms("occurrenceMinDistance", 0), 4),
        # Apart from each other they may each find the task idle.
        ("PeriodicBurstStimulus", OF_FOUR, BURST + '<occurrenceMinDistance value="1" unit="ns"/>', 1),
        ("PeriodicBurstStimulus", "", "", 1),
        ("PeriodicSyntheticStimulus", "", RECURRENCE + at(0, 0, 0), 3),
        ("PeriodicSyntheticStimulus", "", RECURRENCE + at(1) + '<occurrenceTimes value="1000" unit="us"/>', 2),
        ("PeriodicSyntheticStimulus", "", at(0, 1), 1),
        # The second one meets the first one of the next round.
        ("PeriodicSyntheticStimulus", "", at(1, 11) + RECURRENCE, 2),
        ("PeriodicSyntheticStimulus", "", "", 1),
        ("ArrivalCurveStimulus", "", curve(4, "lowerTimeBorder", 1), 3),
        ("ArrivalCurveStimulus", "", curve(2, "lowerTimeBorder", 1) + curve(4, "lowerTimeBorder", 9), 1),
        ("ArrivalCurveStimulus", "", "", 1),
        ("InterProcessStimulus", "", "", 1),
        ("CustomStimulus", "", "", 1),
    ],
)
def test_activations_at_once(kind, attributes, parts, at_once, tmp_path):
    assert activations(kind, attributes, parts, at_once, tmp_path) == []
    if at_once > 1:
        limit = at_once - 1
        expected = [f"'S' may activate 'T' {at_once} times at once, but its activation limit is {limit}"]
        assert activations(kind, attributes, parts, limit, tmp_path) == expected


def activations(kind, attributes, parts, limit, folder):
    tasks = f'<swModel><tasks name="T" stimuli="S?type={kind}" multipleTaskActivationLimit="{limit}"/></swModel>'
    return found("TIM-ACTIVATION-LIMIT", STIMULUS.format(kind, attributes, parts) + tasks, folder)


def jitter(upper, least=""):
    return f"""
<recurrence value="10" unit="ms"/>
<jitter t="TimeBoundaries"><lowerBound value="-1" unit="ms"/><upperBound value="{upper}" unit="us"/></jitter>{least}"""


@pytest.mark.parametrize(
    ("parts", "at_once"),
    [
        (jitter(8_999), 1),
        # The jitter ranges over a whole period: one comes as late as it can, the next one as early as it can.
        (jitter(9_000), 2),
        (jitter(18_999), 2),
        (jitter(19_000), 3),
        (jitter(19_000, '<minDistance value="1" unit="us"/>'), 1),
        ('<recurrence value="10" unit="ms"/>', 1),
        ('<recurrence value="0" unit="ms"/>', 1),
    ],
)
def test_activations_that_jitter_brings_together(parts, at_once, tmp_path):
    assert activations("PeriodicStimulus", "", parts, at_once, tmp_path) == []
    if at_once > 1:
        assert len(activations("PeriodicStimulus", "", parts, at_once - 1, tmp_path)) == 1


def test_the_limit_that_nobody_states_is_1(tmp_path):
    excerpt = STIMULUS.format("PeriodicBurstStimulus", 'occurrenceCount="2"', BURST)
    told = found(
        "TIM-ACTIVATION-LIMIT",
        excerpt + '<swModel><tasks name="T" stimuli="S?type=PeriodicBurstStimulus"/></swModel>',
        tmp_path,
    )
    assert told == ["'S' may activate 'T' 2 times at once, but its activation limit is 1"]


# Deadlines


def deadlines(stimuli, requirement=None, parameter=None, limit_type="UpperLimit", metric="ResponseTime"):
    limit = f"""
<requirements t="ProcessRequirement" name="R" process="T?type=Task">
  <limit t="TimeRequirementLimit" limitType="{limit_type}" metric="{metric}">
    <limitValue value="{requirement}" unit="ms"/>
  </limit>
</requirements>"""
    stated = f"""
<schedulingParameters key="deadline?type=SchedulingParameterDefinition">
  <value t="Time" value="{parameter}" unit="ms"/>
</schedulingParameters>"""
    return f"""
<stimuliModel>
  <stimuli t="PeriodicStimulus" name="P"><recurrence value="10" unit="ms"/></stimuli>
  <stimuli t="PeriodicStimulus" name="Q"><recurrence value="40" unit="ms"/></stimuli>
  <stimuli t="SingleStimulus" name="O"/>
  <stimuli t="CustomStimulus" name="C"/>
</stimuliModel>
<osModel>
  <schedulingParameterDefinitions name="deadline"/>
  <operatingSystems name="OS"><taskSchedulers name="S"/></operatingSystems>
</osModel>
<swModel><tasks name="T" stimuli="{stimuli}"/></swModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler">{stated if parameter else ""}</taskAllocation>
</mappingModel>
<constraintsModel>{limit if requirement else ""}</constraintsModel>"""


P, Q = "P?type=PeriodicStimulus", "Q?type=PeriodicStimulus"


@pytest.mark.parametrize(
    ("excerpt", "told"),
    [
        (deadlines(P, 10, 10), ""),
        (deadlines(P, 11), "11 ms, longer than the 10 ms"),
        (deadlines(P, None, 12), "12 ms, longer than the 10 ms"),
        # Whoever keeps the shorter one is done before the next activation.
        (deadlines(P, 11, 9), ""),
        (deadlines(P, 9, 11), ""),
        (deadlines(P), ""),
        (deadlines(P, 11, limit_type="LowerLimit"), ""),
        (deadlines(P, 11, metric="StartDelay"), ""),
        # 5 activations in 40 ms.
        (deadlines(f"{P} {Q}", 9), "9 ms, longer than the 8 ms"),
        (deadlines("O?type=SingleStimulus", 9), ""),
        (deadlines("C?type=CustomStimulus", 9), ""),
        (deadlines("", 9), ""),
    ],
)
def test_deadlines(excerpt, told, tmp_path):
    expected = [f"the deadline of 'T' is {told} between activations"] if told else []
    assert found("TIM-DEADLINE", excerpt, tmp_path) == expected


# What is executed


@pytest.mark.parametrize(
    ("task", "others", "is_told"),
    [
        (TICK, "", False),
        (call("R"), runnable("R", call("Q")) + runnable("Q", TICK), False),
        ('<items t="SynchronousServerCall" serverRunnable="Q?type=Runnable"/>', runnable("Q", TICK), False),
        ('<items t="AsynchronousServerCall" serverRunnable="Q?type=Runnable"/>', runnable("Q", TICK), True),
        ("", runnable("R", TICK), True),
        ('<items t="Ticks"/>', "", True),
        ('<items t="ExecutionNeed"/>', "", True),
        (call("R"), runnable("R", call("Q")) + runnable("Q", call("R")), True),
        (call("R"), runnable("R", call("Q")) + runnable("Q", TICK, call("R")), False),
    ],
)
def test_processes_that_take_no_time(task, others, is_told, tmp_path):
    excerpt = f'<swModel><tasks name="T">{graph(task)}</tasks>{others}</swModel>'
    assert bool(found("TIM-DEMAND", excerpt, tmp_path)) is is_told


@pytest.mark.parametrize(
    ("task", "others", "expected"),
    [
        (call("R"), runnable("R", call("Q")) + runnable("Q"), []),
        # What only calls itself, or is called by something that is not executed, is not executed either.
        ("", runnable("R", call("R"), call("Q")) + runnable("Q"), ["R", "Q"]),
        ('<items t="SynchronousServerCall" serverRunnable="Q?type=Runnable"/>', runnable("Q"), []),
        (
            '<items t="AsynchronousServerCall" serverRunnable="Q?type=Runnable" resultRunnable="R?type=Runnable"/>',
            runnable("Q") + runnable("R"),
            [],
        ),
        ('<items t="SenderReceiverWrite" notifiedRunnables="Q?type=Runnable"/>', runnable("Q"), []),
        # A prototype runs nothing.
        (
            "",
            runnable("R") + '<processPrototypes name="P"><runnableCalls runnable="R?type=Runnable"/></processPrototypes>',
            ["R"],
        ),
    ],
)
def test_runnables_that_no_process_executes(task, others, expected, tmp_path):
    excerpt = f'<swModel><tasks name="T">{graph(task)}</tasks>{others}</swModel>'
    assert found("TIM-UNREACHABLE", excerpt, tmp_path) == [
        f"runnable {name!r} is not executed by any process" for name in expected
    ]


def test_a_runnable_that_waits_for_itself_as_a_server(tmp_path):
    server = '<items t="SynchronousServerCall" serverRunnable="R?type=Runnable"/>'
    request = '<items t="AsynchronousServerCall" serverRunnable="P?type=Runnable"/>'
    excerpt = f"<swModel>{runnable('R', call('Q'))}{runnable('Q', server)}{runnable('P', request)}</swModel>"
    assert found("TIM-RECURSION", excerpt, tmp_path) == ["'R' calls itself: R -> Q -> R", "'Q' calls itself: Q -> R -> Q"]


def test_what_leads_into_a_circle_or_out_of_it_does_not_call_itself(tmp_path):
    runnables = runnable("A", call("B")) + runnable("B", call("C")) + runnable("C", call("B"), call("D")) + runnable("D")
    told = found("TIM-RECURSION", f"<swModel>{runnables}</swModel>", tmp_path)
    assert told == ["'B' calls itself: B -> C -> B", "'C' calls itself: C -> B -> C"]


def test_a_long_circle_is_not_told_in_full(tmp_path):
    runnables = "".join(runnable(f"R{number}", call(f"R{(number + 1) % 100}")) for number in range(100))
    told = found("TIM-RECURSION", f"<swModel>{runnables}</swModel>", tmp_path)
    assert len(told) == 100
    assert told[0] == "'R0' calls itself: R0 -> R1 -> R2 -> R3 -> R4 -> R5 -> R6 -> R7 -> R8 -> R9 -> ... -> R0"


def test_the_way_through_a_large_circle_is_not_searched(tmp_path):
    def circle(size):
        runnables = "".join(runnable(f"R{number}", call(f"R{(number + 1) % size}")) for number in range(size))
        return model(f"<swModel>{runnables}</swModel>", tmp_path)

    told = [finding.message for finding in check(circle(101), ["TIM-RECURSION"])]
    assert set(told) == {f"'R{number}' calls itself, through 100 other runnables that do so, too" for number in range(101)}
    assert growth(lambda each: check(each, ["TIM-RECURSION"]), [circle(size) for size in (150, 300, 600)]) < 2.5


def test_many_runnables_are_looked_at_in_linear_time(tmp_path):
    # More than Python recurses.
    runnables = "".join(runnable(f"R{number}", call(f"R{number + 1}")) for number in range(2000)) + runnable("R2000")
    excerpt = f'<swModel><tasks name="T">{graph(call("R0"))}</tasks>{runnables}</swModel>'
    rules = ["TIM-RECURSION", "TIM-UNREACHABLE", "TIM-UNIT", "TIM-UNPROTECTED", "TIM-CHAIN-CARRIED"]
    assert check(model(excerpt, tmp_path), rules) == []


# Demand


@pytest.mark.parametrize(
    ("kind", "content", "missing"),
    [
        ("DiscreteValueGaussDistribution", 'lowerBound="1"/>', ["upper"]),
        ("DiscreteValueGaussDistribution", 'upperBound="1"/>', ["lower"]),
        ("DiscreteValueHistogram", "/>", ["lower", "upper"]),
        ("DiscreteValueHistogram", '><entries lowerBound="1" upperBound="2"/></default>', []),
        # What is not stated is 0.
        ("DiscreteValueBoundaries", "/>", []),
        ("DiscreteValueConstant", "/>", []),
    ],
)
def test_bounds(kind, content, missing, tmp_path):
    item = f'<items t="Ticks"><default t="{kind}" {content}</items>'
    expected = [f"the {kind} has no {bound} bound" for bound in missing]
    assert found("TIM-BOUNDS", f"<swModel>{runnable('R', item)}</swModel>", tmp_path) == expected


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ('lowerBound="1" average="5" upperBound="9"', []),
        ('lowerBound="1" average="1" upperBound="9"', ["the average 1.0 is not strictly between the bounds 1 and 9"]),
        ('lowerBound="1" average="9" upperBound="9"', ["the average 9.0 is not strictly between the bounds 1 and 9"]),
        ('lowerBound="1" average="5" upperBound="9" pRemainPromille="999.9"', []),
        (
            'lowerBound="1" average="5" upperBound="9" pRemainPromille="1000"',
            ["the probability of exceeding the upper bound is 1000.0 per mille, but must be greater than 0 and less than 1000"],
        ),
    ],
)
def test_estimators(attributes, expected, tmp_path):
    deviation = f'<default t="DiscreteValueWeibullEstimatorsDistribution" {attributes}/>'
    item = f'<items t="Ticks">{deviation}</items>'
    excerpt = f"<swModel>{runnable('R', item)}</swModel>"
    assert found("TIM-DISTRIBUTION", excerpt, tmp_path) == expected


def two_types(item, features="", tasks="T U", modules=True):
    """A runnable that T calls on a core of the type A, and U on one of the type B."""
    hardware = """
  <structures name="ECU">
    <modules t="ProcessingUnit" name="core0" definition="A?type=ProcessingUnitDefinition"/>
    <modules t="ProcessingUnit" name="core1" definition="B?type=ProcessingUnitDefinition"/>
  </structures>"""
    body = {name: graph(call("R")) if name in tasks.split() else "" for name in ("T", "U")}
    return f"""
<hwModel>
  <definitions t="ProcessingUnitDefinition" name="A" {features}/>
  <definitions t="ProcessingUnitDefinition" name="B"/>
  <featureCategories name="Matrix"><features name="cost" value="2"/><features name="nothing" value="0"/></featureCategories>
  {hardware if modules else ""}
</hwModel>
<osModel>
  <operatingSystems name="OS"><taskSchedulers name="S0"/><taskSchedulers name="S1"/></operatingSystems>
</osModel>
<swModel>{runnable("R", item)}<tasks name="T">{body["T"]}</tasks><tasks name="U">{body["U"]}</tasks></swModel>
<mappingModel>
  <schedulerAllocation scheduler="S0?type=TaskScheduler" responsibility="core0?type=ProcessingUnit"/>
  <schedulerAllocation scheduler="S1?type=TaskScheduler" responsibility="core1?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S0?type=TaskScheduler"/>
  <taskAllocation task="U?type=Task" scheduler="S1?type=TaskScheduler"/>
</mappingModel>"""


ONE = '<value t="DiscreteValueConstant" value="1"/>'


def need(key):
    return f'<items t="ExecutionNeed"><needs key="{key}">{ONE}</needs></items>'


COST = 'features="Matrix/cost?type=HwFeature"'


@pytest.mark.parametrize(
    ("excerpt", "told"),
    [
        (two_types(need("Matrix"), COST), "the cost of need 'Matrix' is not defined for 'core1'"),
        (two_types(need("Matrix"), COST, tasks="T"), ""),
        (two_types(need("Matrix"), COST, tasks=""), ""),
        (two_types(need("Matrix")), "need 'Matrix' is not a feature category of any processing unit in use"),
        (two_types(need("Vector"), COST), "need 'Vector' is not a feature category of any processing unit in use"),
        # What is never called needs nothing.
        *(
            (two_types(need("Matrix"), COST).replace(call("R"), call("R", f"<statistic><statistic {text}/></statistic>")), told)
            for text, told in (
                ('t="SingleValueStatistic" value="1"', "the cost of need 'Matrix' is not defined for 'core1'"),
                ('t="SingleValueStatistic" value="0"', ""),
                ('t="MinAvgMaxStatistic" max="0"', ""),
            )
        ),
        # A cost of nothing is none.
        (
            two_types(need("Matrix"), COST.replace("cost", "nothing")),
            "need 'Matrix' is not a feature category of any processing",
        ),
        # One instruction takes one tick.
        (two_types(need("Instructions")), ""),
        (two_types(need("Vector").replace(' key="Vector"', "")), "need '' is not a feature category of any processing"),
    ],
)
def test_units_of_needs(excerpt, told, tmp_path):
    messages = found("TIM-UNIT", excerpt, tmp_path)
    assert len(messages) == bool(told)
    assert all(told in message for message in messages)


def test_software_without_hardware_may_need_anything(tmp_path):
    assert found("TIM-UNIT", f"<swModel>{runnable('R', need('Vector'))}</swModel>", tmp_path) == []


def extended(definition):
    return f'<items t="Ticks"><extended key="{definition}?type=ProcessingUnitDefinition">{ONE}</extended></items>'


@pytest.mark.parametrize(
    ("excerpt", "expected"),
    [
        (two_types(extended("A")), ["the ticks have no value for 'core1'"]),
        (two_types(extended("A"), tasks="T"), []),
        (two_types(TICK), []),
        (two_types('<items t="Ticks"><extended key="A?type=ProcessingUnitDefinition"/></items>'), ["the ticks have no value"]),
    ],
)
def test_ticks_without_a_value(excerpt, expected, tmp_path):
    assert found("TIM-TICKS", excerpt, tmp_path) == expected


def test_waiting(tmp_path):
    items = '<items t="WaitEvent"><eventMask events="E?type=OsEvent F?type=OsEvent"/></items><items t="WaitEvent"/>'
    excerpt = f'<swModel><tasks name="T">{graph(items)}</tasks><events name="E"/><events name="F"/></swModel>'
    assert found("TIM-WAIT", excerpt, tmp_path) == [
        "the maximum waiting time for 'E' and 'F' is unknown",
        "the maximum waiting time is unknown",
    ]


# Memories


def memory(size='<size value="10" unit="B"/>', label='<size value="8" unit="B"/>', mappings=""):
    return f"""
<swModel>
  <labels name="L" section="S?type=Section">{label}</labels>
  <tasks name="T"><size value="1" unit="B"/></tasks>
  <runnables name="R" section="S?type=Section"><size value="16" unit="bit"/></runnables>
  <sections name="S"/>
</swModel>
<hwModel>
  <definitions t="MemoryDefinition" name="D">{size}</definitions>
  <structures name="ECU">
    <modules t="Memory" name="M" definition="D?type=MemoryDefinition"/>
    <modules t="Memory" name="N"/>
  </structures>
</hwModel>
<mappingModel>{mappings}</mappingModel>"""


def mapped(element, place="M"):
    return f'<memoryMapping abstractElement="{element}" memory="{place}?type=Memory"/>'


SECTION = '<physicalSectionMapping name="P" origin="S?type=Section" memory="M?type=Memory"/>'
FULL = "'M' has a size of 10 B, but the objects mapped to it need 11 B"


@pytest.mark.parametrize(
    ("mappings", "expected"),
    [
        (mapped("L?type=Label") + mapped("R?type=Runnable"), []),
        (mapped("L?type=Label") + mapped("R?type=Runnable") + mapped("T?type=Task"), [FULL]),
        (SECTION, []),
        (SECTION + mapped("T?type=Task"), [FULL]),
        # The same thing by two ways is there once.
        (SECTION + mapped("L?type=Label") + mapped("R?type=Runnable"), []),
        (
            '<physicalSectionMapping name="P" memory="M?type=Memory" labels="L?type=Label" runEntities="R?type=Runnable"/>'
            + mapped("T?type=Task"),
            [FULL],
        ),
        (mapped("L?type=Label") + mapped("R?type=Runnable") + mapped("T?type=Task", "N"), []),
        (
            '<memoryMapping/><memoryMapping memory="M?type=Memory"/><memoryMapping abstractElement="L?type=Label"/>'
            "<physicalSectionMapping/>",
            [],
        ),
    ],
)
def test_what_lies_in_a_memory(mappings, expected, tmp_path):
    assert found("TIM-MEMORY", memory(mappings=mappings), tmp_path) == expected


@pytest.mark.parametrize(
    ("size", "label", "told"),
    [
        ("", "8 B", ""),
        ("10", "80 B", ""),
        ("1 KiB", "1025 B", "a size of 1 KiB, but the objects mapped to it need 1025 B"),
        ("1 KiB", "1024 B", ""),
        ("1 kB", "1 KiB", "a size of 1 kB, but the objects mapped to it need 1 KiB"),
        ("1 kbit", "125 B", ""),
        ("1 kbit", "1001 bit", "a size of 125 B, but the objects mapped to it need 1001 bit"),
        ("0 B", "", ""),
    ],
)
def test_sizes_of_memories(size, label, told, tmp_path):
    def stated(text):
        value, _, unit = text.partition(" ")
        return (f'<size value="{value}" unit="{unit}"/>' if unit else f'<size value="{value}"/>') if text else ""

    messages = found("TIM-MEMORY", memory(stated(size), stated(label), mapped("L?type=Label")), tmp_path)
    assert messages == ([f"'M' has {told}"] if told else [])


# Labels that several cores write


def semaphore(operation, name="X"):
    return f'<items t="SemaphoreAccess" semaphore="{name}?type=Semaphore" access="{operation}"/>'


def shared(first, second, *, others="", label="", consistency="", constraints="", responsibility="core1?type=ProcessingUnit"):
    """What T does on the core 0, and what U and V do on the core 1."""
    return f"""
<hwModel>
  <structures name="ECU">
    <modules t="ProcessingUnit" name="core0"/><modules t="ProcessingUnit" name="core1"/>
  </structures>
</hwModel>
<osModel>
  <semaphores name="X"/><semaphores name="Y"/><semaphores name="Z" maxValue="2"/>
  <operatingSystems name="OS">
    <taskSchedulers name="S0"/><taskSchedulers name="S1"/><interruptControllers name="C"/>
    {consistency}
  </operatingSystems>
</osModel>
<swModel>
  <tasks name="T">{graph(first)}</tasks>
  <tasks name="U">{graph(second)}</tasks>
  {others}
  <labels name="L" {label}/><labels name="M"/>
</swModel>
<mappingModel>
  <schedulerAllocation scheduler="S0?type=TaskScheduler" responsibility="core0?type=ProcessingUnit"/>
  <schedulerAllocation scheduler="S1?type=TaskScheduler" responsibility="{responsibility}"/>
  <schedulerAllocation scheduler="C?type=InterruptController" responsibility="core1?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S0?type=TaskScheduler"/>
  <taskAllocation task="U?type=Task" scheduler="S1?type=TaskScheduler"/>
</mappingModel>
<constraintsModel>{constraints}</constraintsModel>"""


def locked(*items, name="X"):
    return "".join((semaphore("request", name), *items, semaphore("release", name)))


ALONE = semaphore("exclusive", "Z") + access() + semaphore("release", "Z")


@pytest.mark.parametrize(
    ("first", "second", "others", "is_told"),
    [
        (access(), access(), "", True),
        (access(), access("read"), "", False),
        (access(), access("_undefined_"), "", False),
        (access(), access(label="M"), "", False),
        (access() + access(), "", "", False),
        (access(), '<items t="SenderReceiverWrite" label="L?type=Label"/>', "", True),
        # A common semaphore around both, in whatever runnable it is requested.
        (locked(access()), locked(access()), "", False),
        (locked(access()), access(), "", True),
        (locked(access()), locked(access(), name="Y"), "", True),
        (locked(locked(access(), name="Y")), locked(access(), name="Y"), "", False),
        (locked() + access(), locked(access()), "", True),
        (access() + semaphore("request"), locked(access()), "", True),
        (semaphore("request") + access(), locked(access()), "", False),
        (locked(access()) + access(), locked(access()), "", True),
        (locked(call("R")), locked(access()), runnable("R", access()), False),
        (locked(call("R")) + call("R"), locked(access()), runnable("R", access()), True),
        (locked(call("R")), locked(access()), runnable("R", semaphore("release"), access()), True),
        (call("R"), locked(access()), runnable("R", locked(access())), False),
        (
            call("lock") + access() + call("unlock"),
            locked(access()),
            runnable("lock", semaphore("request")) + runnable("unlock", semaphore("release")),
            False,
        ),
        (
            call("lock") + call("unlock") + access(),
            locked(access()),
            runnable("lock", semaphore("request")) + runnable("unlock", semaphore("release")),
            True,
        ),
        # A semaphore for two keeps nobody away, unless it is wanted alone.
        (locked(access(), name="Z"), locked(access(), name="Z"), "", True),
        (ALONE, ALONE, "", False),
        # Copies.
        (access(attributes='implementation="implicit"'), access(), "", False),
        (access(attributes='implementation="timed"'), access(), "", False),
        (access(attributes='implementation="explicit"'), access(), "", True),
        # What is not executed anywhere, or nowhere known.
        (access(), "", runnable("R", access()), False),
        (access(), "", f'<isrs name="I">{graph(access())}</isrs>', False),
    ],
)
def test_labels_that_several_cores_write(first, second, others, is_told, tmp_path):
    told = found("TIM-UNPROTECTED", shared(first, second, others=others), tmp_path)
    expected = ["'L' is written by 'T' on core0 and 'U' on core1 without a common semaphore or a stated protection"]
    assert told == (expected if is_told else [])


@pytest.mark.parametrize(
    ("system", "label", "access_level", "is_told"),
    [
        ("", "", "", True),
        ("automaticProtection", "", "", False),
        ("customProtection", "", "", False),
        # Model elements have to be there, then.
        ("handledByModelElements", "", "", True),
        ("noProtection", "", "", True),
        ("", "automaticProtection", "", False),
        ("", "customProtection", "", False),
        ("", "", "customProtection", False),
        # The access decides, then the label.
        ("automaticProtection", "noProtection", "", True),
        ("automaticProtection", "noProtection", "automaticProtection", False),
        ("noProtection", "automaticProtection", "noProtection", True),
        ("noProtection", "automaticProtection", "inherited", False),
        ("automaticProtection", "_undefined_", "_undefined_", False),
    ],
)
def test_stated_protection(system, label, access_level, is_told, tmp_path):
    consistency = f'<osDataConsistency mode="{system}"/>' if system else ""
    attributes = f'dataStability="{access_level}"' if access_level else ""
    excerpt = shared(
        access(attributes=attributes),
        access(attributes=attributes),
        label=f'dataStability="{label}"' if label else "",
        consistency=consistency,
    )
    assert bool(found("TIM-UNPROTECTED", excerpt, tmp_path)) is is_told


@pytest.mark.parametrize("group", ["dataStabilityGroups", "dataCoherencyGroups"])
def test_groups_of_labels_that_have_to_be_consistent(group, tmp_path):
    excerpt = shared(access(), access(), constraints=f'<{group} name="G" labels="L?type=Label"/>')
    assert found("TIM-UNPROTECTED", excerpt, tmp_path) == []
    excerpt = shared(access(), access(), constraints=f'<{group} name="G" labels="M?type=Label"/>')
    assert len(found("TIM-UNPROTECTED", excerpt, tmp_path)) == 1


def test_tasks_that_move_between_cores_may_write_at_a_time(tmp_path):
    second = f'<tasks name="V">{graph(access())}</tasks>'
    excerpt = shared("", access(), others=second, responsibility="core0?type=ProcessingUnit core1?type=ProcessingUnit")
    allocation = '<taskAllocation task="V?type=Task" scheduler="S1?type=TaskScheduler"/></mappingModel>'
    assert found("TIM-UNPROTECTED", excerpt.replace("</mappingModel>", allocation), tmp_path) == [
        "'L' is written by 'U' on core0/core1 and 'V' on core0/core1 without a common semaphore or a stated protection"
    ]
    # A task alone does not meet itself.
    assert found("TIM-UNPROTECTED", excerpt, tmp_path) == []


def test_tasks_of_one_core_do_not_write_at_a_time(tmp_path):
    second = f'<tasks name="V">{graph(access())}</tasks>'
    allocation = '<taskAllocation task="V?type=Task" scheduler="S1?type=TaskScheduler"/></mappingModel>'
    excerpt = shared("", access(), others=second).replace("</mappingModel>", allocation)
    assert found("TIM-UNPROTECTED", excerpt, tmp_path) == []


def test_interrupts_write_too(tmp_path):
    isr = f'<isrs name="I">{graph(access())}</isrs>'
    allocation = '<isrAllocation isr="I?type=ISR" controller="C?type=InterruptController"/></mappingModel>'
    excerpt = shared(access(), "", others=isr).replace("</mappingModel>", allocation)
    assert found("TIM-UNPROTECTED", excerpt, tmp_path) == [
        "'L' is written by 'T' on core0 and 'I' on core1 without a common semaphore or a stated protection"
    ]


@pytest.mark.parametrize("path", [*every(3, corpus()), *hand_written()])
def test_real_models_without_semaphores(path):
    """What the system that was extracted from a model writes, and where."""
    try:
        read = load(path)
    except ReadError:
        pytest.skip("the file cannot be read")
    system = extract(read).system
    places = {a.task: a.cores or system.schedulers[a.scheduler].cores for a in system.mapping.tasks}
    writers: dict[str, dict[str, set[str]]] = {}
    for what in Dataflow(system).events.all_positions():
        if isinstance(what.activity, LabelAccess) and what.activity.kind is AccessKind.WRITE:
            writers.setdefault(what.activity.label, {})[what.process.name] = set(places.get(what.process.name, ()))
    expected = {label for label, by in writers.items() if len(by) > 1 and len(set().union(*by.values())) > 1}
    assert not system.os.semaphores or not expected
    assert {finding.object for finding in check(read, ["TIM-UNPROTECTED"])} == expected
