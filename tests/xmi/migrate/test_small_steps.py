"""Steps that change little, as far as neither the pairs of models nor steps/*.txt show it."""

import pytest
from inline_models import text_property
from migration import migrated

from amalthea_uros.xmi.tree.node import all_below
from amalthea_uros.xmi.tree.notes import NoteKind

# 0.7.2 -> 0.8.0


STEP = ("0.7.2", "0.8.0")


def test_common_elements_can_be_a_root(up):
    assert up('<tags name="t"/>', root="CommonElements").lines[1:] == ["Amalthea", "commonElements", "tags name='t'"]


TIMES = """
<stimuliModel>
  <stimuli t="Periodic" name="p"><customProperties key="k"><value t="SignedTimeObject" value="1"/></customProperties>
    <stimulusDeviation><lowerBound t="SignedTime" value="2"/></stimulusDeviation></stimuli>
  <clocks t="ClockSinusFunction" name="c"><shift t="SignedTime" value="3"/></clocks>
</stimuliModel>
<constraintsModel><requirements><limit t="TimeRequirementLimit"><limitValue t="SignedTime" value="4"/></limit>
</requirements></constraintsModel>
"""


def test_signed_times_are_times_everywhere(up):
    result = up(TIMES)
    assert "Signed" not in result.text
    assert "value [TimeObject] value='1'" in result.lines
    assert "limitValue [Time] value='4'" in result.lines


def test_damaged_files_are_no_problem(up):
    up(
        '<mappingModel><mapping t="Unknown"/><mapping/></mappingModel><swModel><modeLabels mode="x"/>'
        '<modeLabels mode="y" initialValue="z"/></swModel>'
        "<osModel><osDataConsistency/><osDataConsistency/><operatingSystems/></osModel>"
        "<propertyConstraintsModel><mappingConstraints/><allocationConstraints><hwConstraint/><hwConstraint/></allocationConstraints>"
        "</propertyConstraintsModel>",
    )


# 0.9.0 -> 0.9.1


TEXT = """<stimuliModel><stimuli t="PeriodicStimulus" name="P">
    <customProperties key="k"><value t="MapObject"><entries key="a"><value t="TimeObject" value="1" unit="ms"/></entries></value>
    </customProperties><jitter><lowerBound t="TimeObject" value="1" unit="ms"/></jitter></stimuli></stimuliModel>"""


@pytest.mark.parametrize(("version", "target"), [("0.9.0", "0.9.1"), ("0.9.1", "0.9.2"), ("0.9.2", "0.9.2")])
def test_times_everywhere(models, version, target):
    found, _ = migrated(models.files("before", version, TEXT), target)
    assert {node.type for node in found.trees[0].root.walk() if node.get("unit")} == {"Time"}


# Event chains and conditions about modes, up to 0.9.7


EVENTS = '<eventModel><events t="ProcessEvent" name="a"/><events t="ProcessEvent" name="b"/></eventModel>'
ENDS = 'stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"'


def chains(content):
    return f"{EVENTS}<constraintsModel>{content}</constraintsModel>"


@pytest.mark.parametrize("scope", ["c", "outer", "outermost"])
def test_parallel_chains_are_to_be_checked_also_as_parts_of_chains_with_a_latency_constraint(models, scope):
    constraint = f'<timingConstraints t="EventChainLatencyConstraint" name="l" scope="{scope}?type=EventChain"/>'
    segment = '<segments t="EventChainReference" eventChain="{}?type=EventChain"/>'
    strands = '<strands t="EventChainReference" eventChain="x?type=EventChain"/>'
    inner = f'<segments t="EventChainContainer"><eventChain {ENDS}>{segment.format("c")}</eventChain></segments>'
    chain = f"""<eventChains name="c" {ENDS}>{strands}</eventChains><eventChains name="x" {ENDS}>{segment.format("x")}</eventChains>
        <eventChains name="outer" {ENDS}>{inner}</eventChains>
        <eventChains name="outermost" {ENDS}>{segment.format("outer")}</eventChains>"""
    models.migrate("0.9.5", "0.9.7", chains(chain + constraint))
    assert ["latency constraint" in message for message in models.messages(NoteKind.TO_CHECK)] == [True]


@pytest.mark.parametrize("version", ["0.9.5", "0.9.6", "0.9.7"])
def test_what_is_in_the_new_form_stays(models, version):
    content = f"""<eventChains name="c" {ENDS} itemType="parallel" minItemsCompleted="2">
        <items t="EventChainReference" eventChain="c?type=EventChain"/></eventChains>"""
    assert models.migrate(version, "0.9.8", chains(content)) == models.read("0.9.8", chains(content))


# Measurements until 1.0.0, and limits of numbers that became tighter in 1.2.0


def measured(properties, measurements):
    return f'<swModel><tasks name="T 1">{properties}</tasks></swModel>{measurements}'


MEASUREMENT = f"""<measurementModel><measurements t="TaskMeasurement" task="T+1?type=Task">{text_property("tool", "X")}
    <runtimes value="5" unit="us"/><runtimes value="7" unit="us"/>
    <runtimeDeviation t="TimeBoundaries"><lowerBound value="1" unit="us"/><upperBound value="9" unit="us"/></runtimeDeviation>
  </measurements></measurementModel>"""


def test_comments_on_a_measurement_stay_with_what_was_measured(models):
    content = measured("", MEASUREMENT.replace("<measurements ", "<!-- on the bench --><measurements "))
    roots = migrated(models.files("before", "0.9.9", content), "1.0.0")[0].roots
    assert [task.comments for task in roots[0].find("swModel", "tasks")] == [["<!-- on the bench -->"]]


@pytest.mark.parametrize("text", ["-1", "many", "", "1", "99"])
def test_other_numbers_stay(models, text):
    content = f'<stimuliModel><stimuli t="PeriodicBurstStimulus" name="B" occurrenceCount="{text}"/></stimuliModel>'
    assert models.migrate("1.1.0", "1.2.0", content) == models.read("1.2.0", content)
    assert len(models.messages(NoteKind.TO_CHECK)) == (text == "-1")


# Switches and data types of 3.0.0


def software(content):
    return f'<swModel>{content}<typeDefinitions t="BaseTypeDefinition" name="u 8"/></swModel>'


ARRAY = """<{0} t="Array" numberElements="{1}">
  <dataType t="TypeRef" typeDef="u+8?type=BaseTypeDefinition"/></{0}>"""


def test_comments_on_a_type_that_goes_away_stay_with_the_label(models):
    reference = '<!--{}--><dataType t="TypeRef" typeDef="u+8?type=BaseTypeDefinition"/>'
    array = "<!--{}-->" + ARRAY.format("dataType", 1)
    before = f"""<labels name="A">{reference.format(1)}</labels><labels name="B">{array.format(2)}</labels>
      <labels name="C">{array.format(3)}{array.format(4)}</labels><labels name="D"><!--5--><dataType t="TypeRef"/></labels>"""
    roots = migrated(models.files("before", "2.2.0", software(before)), "3.0.0")[0].roots
    commented = [(node.tag, node.name, node.comments) for node in all_below(roots) if node.comments]
    assert commented == [
        ("labels", "A", ["<!--1-->"]),
        ("labels", "C", ["<!--3-->", "<!--4-->"]),
        ("labels", "D", ["<!--5-->"]),
        ("dataType", "", ["<!--2-->"]),
    ]


@pytest.mark.parametrize("version", ["2.2.0", "3.0.0", "3.1.0"])
def test_switches_of_isrs_and_runnables_also_in_snapshots(models, version):
    text = """<swModel><isrs name="I"><activityGraph><items t="{0}"><entries name="e"><condition>
        <entries t="{1}"/></condition><items t="{0}"/></entries></items></activityGraph></isrs>
      <runnables name="R"><activityGraph><items t="{0}"/></activityGraph></runnables></swModel>"""
    before = text.format("ModeSwitch", "ModeConditionConjunction")
    assert models.migrate(version, "3.2.0", before) == models.read("3.2.0", text.format("Switch", "ConditionConjunction"))


# 2.1.0 -> 2.0.0


def condition(content):
    return f'<swModel><runnables name="R"><executionCondition>{content}</executionCondition></runnables></swModel>'


@pytest.mark.parametrize("tag", ["tasks", "isrs", "runnables"])
def test_local_mode_labels_are_an_error(models, tag):
    before = f"""<swModel>
    <modes t="NumericMode" name="m"/><modeLabels name="G" mode="m?type=NumericMode"/>
    <{tag} name="X"><localLabels name="L" mode="m?type=NumericMode"/><activityGraph>
    <items t="ModeLabelAssignment" globalLabel="G?type=ModeLabel"/>
    <items t="LocalModeLabelAssignment"><valueSource t="IntegerConst" value="1"/></items>
    <items t="RunnableCall"><context><valueSource t="IntegerConst" value="1"/></context></items>
    </activityGraph></{tag}></swModel>
    <eventModel><events t="ModeLabelEvent" name="E" entity="G?type=ModeLabel"/></eventModel>"""
    after = f"""<swModel>
    <modes t="NumericMode" name="m"/><modeLabels name="G" mode="m?type=NumericMode"/>
    <{tag} name="X"><activityGraph><items t="RunnableCall"/></activityGraph></{tag}></swModel><eventModel/>"""
    assert models.migrate("2.1.0", "2.0.0", before) == models.read("2.0.0", after)
    assert sorted(message.partition(":")[0] for message in models.messages(NoteKind.LOST)) == [
        "assignment between a mode label and a local one",
        "assignment to a local mode label",
        "context of a runnable call",
        "event of a mode label",
        "local mode label",
    ]


@pytest.mark.parametrize(
    "content",
    [
        '<entries t="LocalModeCondition" relation="EQUAL"/>',
        '<entries t="ModeValueCondition" relation="LESS_THAN_OR_EQUAL" value="1"/>',
        '<entries t="ModeLabelCondition" relation="GREATER_THAN_OR_EQUAL"/>',
        '<entries t="ChannelFillCondition" relation="EQUAL" fillLevel="1"/>',
        '<entries t="ConditionConjunction"><entries t="LocalModeCondition"/></entries>',
    ],
)
def test_new_conditions_are_an_error(models, content):
    models.migrate("2.1.0", "2.0.0", condition(content))
    assert len(models.messages(NoteKind.LOST)) == 1


# 3.0.0 -> 2.2.0


def semaphore(attributes, kept=""):
    value = f'<value t="BooleanObject" value="{kept}"/>'
    content = f'<customProperties key="AMALTHEA 3.0.0: ownership">{value}</customProperties>' if kept else ""
    return f'<osModel><semaphores name="S" maxValue="1" {attributes}>{content}</semaphores></osModel>'


@pytest.mark.parametrize(
    ("kind", "stated", "kept"),
    [
        ("CountingSemaphore", "false", ""),
        ("CountingSemaphore", "true", "true"),
        ("CountingSemaphore", None, "true"),
        ("Resource", "true", ""),
        ("Resource", None, ""),
        ("Spinlock", "false", "false"),
    ],
)
def test_ownership_is_kept_where_the_type_does_not_say_it(models, kind, stated, kept):
    attributes = f'semaphoreType="{kind}"'
    before = semaphore(attributes + (f' ownership="{stated}"' if stated else ""))
    assert models.migrate("3.0.0", "2.2.0", before) == models.read("2.2.0", semaphore(attributes, kept))
    assert len(models.messages(NoteKind.KEPT)) == bool(kept)
    restored = models.read("3.0.0", semaphore(attributes + (f' ownership="{kept}"' if kept else "")))
    if kept:
        assert models.migrate("2.2.0", "3.0.0", semaphore(attributes, kept)) == restored
