"""The rules of APP4MC's TA profile, by what the reference says of them beyond their examples."""

import pytest
from excerpts import found

# Gauss distributions


def ticks(attributes):
    return f"""
<swModel>
  <runnables name="R"><activityGraph><items t="Ticks">
    <default t="DiscreteValueGaussDistribution" sd="1" {attributes}/>
  </items></activityGraph></runnables>
</swModel>"""


def rate(attributes):
    return f"""
<stimuliModel>
  <stimuli t="VariableRateStimulus" name="S">
    <occurrencesPerStep t="ContinuousValueGaussDistribution" sd="1" {attributes}/>
  </stimuli>
</stimuliModel>"""


OUTSIDE = [
    ('mean="0.5" lowerBound="1" upperBound="9"', ["the mean 0.5 is below the lower bound 1"]),
    ('mean="9.5" lowerBound="1" upperBound="9"', ["the mean 9.5 is above the upper bound 9"]),
    ('mean="0.5" lowerBound="1"', ["the mean 0.5 is below the lower bound 1"]),
    ('mean="9.5" upperBound="9"', ["the mean 9.5 is above the upper bound 9"]),
    # A mean that is not stated is 0.
    ('lowerBound="1"', ["the mean 0 is below the lower bound 1"]),
    (
        'mean="5" lowerBound="9" upperBound="1"',
        ["the mean 5.0 is below the lower bound 9", "the mean 5.0 is above the upper bound 1"],
    ),
    ('mean="1" lowerBound="1" upperBound="1"', []),
    ('mean="100"', []),
    ('mean="NaN" lowerBound="1" upperBound="9"', []),
    ('mean="Infinity" upperBound="9"', []),
    ('mean="-Infinity" lowerBound="1"', []),
]


@pytest.mark.parametrize(("attributes", "expected"), OUTSIDE)
def test_the_mean_of_whole_numbers(attributes, expected, tmp_path):
    assert found("TA-Basic-DiscreteValueGaussDistribution-mean", ticks(attributes), tmp_path) == expected


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        *((attributes, bool(expected)) for attributes, expected in OUTSIDE),
        ('mean="5" lowerBound="Infinity"', False),
        ('mean="5" lowerBound="NaN" upperBound="4.5"', True),
    ],
)
def test_the_mean_of_numbers(attributes, expected, tmp_path):
    assert bool(found("TA-Basic-ContinuousValueGaussDistribution-mean", rate(attributes), tmp_path)) is expected


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        (
            '<lowerBound value="2" unit="ms"/><mean value="1999" unit="us"/>',
            ["the mean 1.999 ms is below the lower bound 2 ms"],
        ),
        ('<lowerBound value="2" unit="ms"/><mean value="2000" unit="us"/>', []),
        (
            '<upperBound value="2" unit="ms"/><mean value="2001" unit="us"/>',
            ["the mean 2.001 ms is above the upper bound 2 ms"],
        ),
        ('<mean value="2001" unit="us"/>', []),
        ('<upperBound value="2" unit="ms"/>', []),
        # Without a unit it is no time.
        ('<upperBound value="2"/><mean value="3" unit="us"/>', []),
    ],
)
def test_the_mean_of_times(parts, expected, tmp_path):
    excerpt = f"""
<stimuliModel>
  <stimuli t="PeriodicStimulus" name="S"><jitter t="TimeGaussDistribution">{parts}</jitter></stimuli>
</stimuliModel>"""
    assert found("TA-Basic-TimeGaussDistribution-mean", excerpt, tmp_path) == expected


# Times in order

CONSTRAINTS = "<constraintsModel>{}</constraintsModel>"
TIMING = '<timingConstraints t="{}" name="C">{}</timingConstraints>'


def data_age(parts):
    return f'<dataAgeConstraints name="D"><dataAge t="DataAgeTime">{parts}</dataAge></dataAgeConstraints>'


@pytest.mark.parametrize(
    ("rule", "holder", "least", "greatest", "what"),
    [
        ("TA-Constraints-DataAgeTime", data_age, "minimumTime", "maximumTime", "age"),
        ("TA-Constraints-DelayConstraint", lambda parts: TIMING.format("DelayConstraint", parts), "lower", "upper", "delay"),
        (
            "TA-Constraints-ECLConstraint",
            lambda parts: TIMING.format("EventChainLatencyConstraint", parts),
            "minimum",
            "maximum",
            "latency",
        ),
        (
            "TA-Constraints-RepetitionConstraint",
            lambda parts: TIMING.format("RepetitionConstraint", parts),
            "lower",
            "upper",
            "distance",
        ),
    ],
)
def test_least_times_above_the_greatest(rule, holder, least, greatest, what, tmp_path):
    def reported(*parts):
        return found(rule, CONSTRAINTS.format(holder("".join(parts))), tmp_path)

    above = f'<{greatest} value="2" unit="ms"/>'
    assert reported(f'<{least} value="2001" unit="us"/>', above) == [
        f"the minimum {what} 2.001 ms is above the maximum {what} 2 ms"
    ]
    assert reported(f'<{least} value="2000" unit="us"/>', above) == []
    assert reported(f'<{least} value="3" unit="ms"/>') == []
    assert reported(above) == []
    assert reported(f'<{least} value="3"/>', above) == []


# Deadlines


def scheduled(definition, limit="", allocations=1):
    allocation = '<taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>'
    return f"""
<osModel>
  <schedulerDefinitions name="{definition}"/>
  <operatingSystems name="OS"><taskSchedulers name="S" definition="{definition}?type=SchedulerDefinition"/></operatingSystems>
</osModel>
<swModel><tasks name="T"/></swModel>
<mappingModel>{allocation * allocations}</mappingModel>
<constraintsModel>
  <requirements t="ProcessRequirement" name="R" process="T?type=Task">{limit}</requirements>
</constraintsModel>"""


EDF = "TA-Constraints-EDFTaskMustHaveDeadline"
LIMIT = '<limit t="TimeRequirementLimit" limitType="{}" metric="{}"><limitValue value="1" unit="ms"/></limit>'


@pytest.mark.parametrize(
    ("definition", "limit", "is_reported"),
    [
        ("EarliestDeadlineFirst", "", True),
        ("EarliestDeadlineFirst", LIMIT.format("UpperLimit", "ResponseTime"), False),
        ("EarliestDeadlineFirst", LIMIT.format("LowerLimit", "ResponseTime"), True),
        ("EarliestDeadlineFirst", LIMIT.format("UpperLimit", "StartDelay"), True),
        ("FixedPriorityPreemptive", "", False),
    ],
)
def test_tasks_by_deadline(definition, limit, is_reported, tmp_path):
    assert bool(found(EDF, scheduled(definition, limit), tmp_path)) is is_reported


def test_a_task_that_is_allocated_to_nothing_needs_no_deadline(tmp_path):
    assert found(EDF, scheduled("EarliestDeadlineFirst", allocations=0), tmp_path) == []


def test_tasks_by_deadline_until_1_2(tmp_path):
    excerpt = """
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"><schedulingAlgorithm t="EarliestDeadlineFirst"/></taskSchedulers>
  </operatingSystems>
</osModel>
<swModel><tasks name="T"/></swModel>
<mappingModel><taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/></mappingModel>"""
    assert found(EDF, excerpt, tmp_path, "1.2.0") == ["'T' is scheduled by EDF, but no requirement limits its response time"]


@pytest.mark.parametrize(
    ("metric", "value", "is_reported"),
    [("ResponseTime", 0, True), ("ResponseTime", -1, True), ("ResponseTime", 1, False), ("Lateness", 0, False)],
)
def test_limits_of_response_times(metric, value, is_reported, tmp_path):
    limit = f"""<limit t="TimeRequirementLimit" metric="{metric}"><limitValue value="{value}" unit="ms"/></limit>"""
    excerpt = CONSTRAINTS.format(f'<requirements t="ProcessRequirement" name="R">{limit}</requirements>')
    assert bool(found("TA-Constraints-RTLimitMustBePositive", excerpt, tmp_path)) is is_reported


def test_a_limit_without_a_value_is_not_judged(tmp_path):
    limit = '<limit t="TimeRequirementLimit" metric="ResponseTime"/>'
    excerpt = CONSTRAINTS.format(f'<requirements t="ProcessRequirement" name="R">{limit}</requirements>')
    assert found("TA-Constraints-RTLimitMustBePositive", excerpt, tmp_path) == []


# Instructions per cycle


@pytest.mark.parametrize(
    ("category", "feature", "value", "is_reported"),
    [
        ("Instructions", "IPC_1", 'value="0"', True),
        ("INSTRUCTIONS", "IPC_1", 'value="-1.5"', True),
        # What is not stated is 0.
        ("Instructions", "IPC_1", "", True),
        ("Instructions", "IPC_1", 'value="0.1"', False),
        ("Instructions", "IPC_1", 'value="NaN"', False),
        ("Instructions", "IPC_1", 'value="-Infinity"', False),
        ("Instructions", "IPC", 'value="0"', False),
        ("Instructions", "ipc_1", 'value="0"', False),
        ("Power", "IPC_1", 'value="0"', False),
    ],
)
def test_instructions_per_cycle(category, feature, value, is_reported, tmp_path):
    excerpt = f"""
<hwModel><featureCategories name="{category}"><features name="{feature}" {value}/></featureCategories></hwModel>"""
    assert bool(found("TA-Hardware-HWFIPCMustBePositive", excerpt, tmp_path)) is is_reported


@pytest.mark.parametrize(
    ("kind", "features", "expected"),
    [
        ("CPU", "", ["IPC of 'D' is not defined; assuming 1.0"]),
        ("CPU", "Instructions/other?type=HwFeature", ["IPC of 'D' is not defined; assuming 1.0"]),
        ("CPU", "Power/IPC_3?type=HwFeature", ["IPC of 'D' is not defined; assuming 1.0"]),
        ("CPU", "Instructions/IPC_1?type=HwFeature", []),
        (
            "CPU",
            "Instructions/IPC_1?type=HwFeature Instructions/IPC_2?type=HwFeature",
            ["IPC of 'D' is defined 2 times; using the first value"],
        ),
        ("GPU", "", []),
        ("_undefined_", "", []),
    ],
)
def test_the_instructions_per_cycle_of_a_processor(kind, features, expected, tmp_path):
    excerpt = f"""
<hwModel>
  <definitions t="ProcessingUnitDefinition" name="D" puType="{kind}" features="{features}"/>
  <featureCategories name="Instructions">
    <features name="IPC_1" value="1"/><features name="IPC_2" value="2"/><features name="other" value="3"/>
  </featureCategories>
  <featureCategories name="Power"><features name="IPC_3" value="1"/></featureCategories>
</hwModel>"""
    assert found("TA-Hardware-PUDIPCMissing", excerpt, tmp_path) == expected


# Conditions on modes


def condition(*entries, conjunction=True, literals=("on", "off"), kind="EnumMode"):
    """A condition of (relation, value[, label]) on a mode label."""
    rows = [(*entry, "L") if len(entry) == 2 else entry for entry in entries]
    conditions = "".join(
        f'<entries t="ModeValueCondition" label="{label}?type=ModeLabel" relation="{relation}" value="{value}"/>'
        for relation, value, label in rows
    )
    if conjunction:
        conditions = f'<entries t="ConditionConjunction">{conditions}</entries>'
    inner = "".join(f'<literals name="{literal}"/>' for literal in literals) if kind == "EnumMode" else ""
    return f"""
<swModel>
  <runnables name="R"><executionCondition>{conditions}</executionCondition></runnables>
  <modes t="{kind}" name="M">{inner}</modes>
  <modeLabels name="L" mode="M?type={kind}"/>
  <modeLabels name="K" mode="M?type={kind}"/>
</swModel>"""


FALSE = "TA-Software-ModeConditionConjunctionAlwaysFalse"
TRUE = "TA-Software-ModeConditionDisjunctionAlwaysTrue"


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        ([("EQUAL", "on"), ("EQUAL", "off")], ["'L' must equal 'on' and 'off' at the same time"]),
        ([("EQUAL", "on"), ("EQUAL", "on")], []),
        ([("EQUAL", "on"), ("EQUAL", "off", "K")], []),
        # By the reference, whether there is a third literal or not.
        ([("NOT_EQUAL", "on"), ("NOT_EQUAL", "off")], ["'L' must differ from 'on' and 'off'"]),
        ([("EQUAL", "on"), ("NOT_EQUAL", "on")], ["'L' must both equal and differ from 'on'"]),
        ([("EQUAL", "on"), ("NOT_EQUAL", "off")], []),
        ([("EQUAL", "on"), ("LESS_THAN", "on"), ("_undefined_", "off")], []),
    ],
)
def test_conditions_that_cannot_all_be_true(entries, expected, tmp_path):
    assert found(FALSE, condition(*entries, literals=("on", "off", "broken")), tmp_path) == expected
    assert found(TRUE, condition(*entries), tmp_path) == []


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        ([("EQUAL", "on"), ("EQUAL", "off")], ["'L' may have any of its literals"]),
        ([("EQUAL", "on"), ("EQUAL", "off", "K")], []),
        ([("EQUAL", "on")], []),
        ([("EQUAL", "on"), ("NOT_EQUAL", "on")], ["'L' may equal 'on' or differ from it"]),
        ([("EQUAL", "on"), ("NOT_EQUAL", "off")], []),
        # Always true, too, but not reported by the reference.
        ([("NOT_EQUAL", "on"), ("NOT_EQUAL", "off")], []),
    ],
)
def test_conditions_of_which_one_is_always_true(entries, expected, tmp_path):
    assert found(TRUE, condition(*entries, conjunction=False), tmp_path) == expected
    assert found(FALSE, condition(*entries, conjunction=False), tmp_path) == []


def test_more_literals_than_are_accepted(tmp_path):
    entries = [("EQUAL", "on"), ("EQUAL", "off")]
    assert found(TRUE, condition(*entries, conjunction=False, literals=("on", "off", "broken")), tmp_path) == []


def test_a_mode_without_literals_is_never_any_of_them(tmp_path):
    assert found(TRUE, condition(("NOT_EQUAL", "on"), conjunction=False, literals=()), tmp_path) == []


def test_numbers_are_not_compared(tmp_path):
    entries = [("EQUAL", "1"), ("EQUAL", "2"), ("NOT_EQUAL", "1")]
    assert found(FALSE, condition(*entries, kind="NumericMode"), tmp_path) == []
    assert found(TRUE, condition(*entries, kind="NumericMode", conjunction=False), tmp_path) == []


@pytest.mark.parametrize("version", ["0.9.7", "1.2.0"])
def test_conditions_of_older_versions(version, tmp_path):
    both = condition(("EQUAL", "on"), ("EQUAL", "off"))
    assert len(found(FALSE, both.replace("ConditionConjunction", "ModeConditionConjunction"), tmp_path, version)) == 1
    either = condition(("EQUAL", "on"), ("EQUAL", "off"), conjunction=False)
    assert len(found(TRUE, either, tmp_path, version)) == 1


# Events, calls, semaphores


@pytest.mark.parametrize(
    ("items", "is_reported"),
    [
        (["WaitEvent"], True),
        (["WaitEvent", "ClearEvent"], True),
        (["WaitEvent", "SetEvent"], False),
        (["SetEvent"], False),
        (["ClearEvent"], False),
        ([], False),
    ],
)
def test_events_that_are_never_set(items, is_reported, tmp_path):
    graph = "".join(f'<items t="{item}"><eventMask events="F?type=OsEvent E?type=OsEvent"/></items>' for item in items)
    both = '<items t="SetEvent"><eventMask events="F?type=OsEvent"/></items><items t="WaitEvent"/>'
    excerpt = f"""
<swModel>
  <tasks name="T"><activityGraph>{graph}{both}</activityGraph></tasks>
  <events name="E"/><events name="F"/>
</swModel>"""
    expected = ["'E' is waited for, but never set"] if is_reported else []
    assert found("TA-Stimuli-ArrivalCurveStimulus", excerpt, tmp_path) == expected


def runnables(item):
    return f"""
<swModel>
  <tasks name="T"><activityGraph>{item}</activityGraph></tasks>
  <runnables name="R"><activityGraph><items t="Group">{item}</items></activityGraph></runnables>
  <runnables name="Q"><activityGraph>{item}</activityGraph></runnables>
</swModel>"""


def test_a_runnable_that_calls_itself(tmp_path):
    # Calls through others are not reported.
    item = '<items t="RunnableCall" runnable="R?type=Runnable"/>'
    assert found("TA-Software-RunnableCall", runnables(item), tmp_path) == ["'R' calls itself"]


@pytest.mark.parametrize("call", ["SynchronousServerCall", "AsynchronousServerCall", "GetResultServerCall"])
def test_a_runnable_that_is_its_own_server(call, tmp_path):
    item = f'<items t="{call}" serverRunnable="R?type=Runnable"/>'
    assert found("TA-Software-ServerCall", runnables(item), tmp_path) == ["'R' calls itself as a server"]


@pytest.mark.parametrize(
    ("attributes", "version", "expected"),
    [
        ("", "3.3.0", []),
        ('initialValue="1"', "3.3.0", []),
        ('initialValue="2"', "3.3.0", ["the initial value 2 of 'S' is above the maximum value 1"]),
        (
            'initialValue="-1"',
            "2.0.0",
            [
                "the initial value of 'S' is -1, but must be 0 or more",
                "the maximum value of 'S' is 0, but must be greater than 0",
            ],
        ),
        ('maxValue="0"', "2.0.0", ["the maximum value of 'S' is 0, but must be greater than 0"]),
        (
            'initialValue="1" maxValue="0"',
            "2.0.0",
            [
                "the maximum value of 'S' is 0, but must be greater than 0",
                "the initial value 1 of 'S' is above the maximum value 0",
            ],
        ),
        # Until 2.0 the default of the maximum value is 0.
        ("", "2.0.0", ["the maximum value of 'S' is 0, but must be greater than 0"]),
        ("", "2.1.0", []),
    ],
)
def test_semaphores(attributes, version, expected, tmp_path):
    excerpt = f'<osModel><semaphores name="S" {attributes}/></osModel>'
    assert found("TA-Misc-Semaphore", excerpt, tmp_path, version) == expected
