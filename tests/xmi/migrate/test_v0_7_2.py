"""0.7.1 -> 0.7.2: what the pairs of models do not show."""

import pytest
from inline_models import migrate


@pytest.fixture
def up(tmp_path):
    def run(*contents, root="Amalthea", source="0.7.1"):
        return migrate(tmp_path, source, "0.7.2", *contents, root=root)

    return run


def runnable(items):
    return f'<swModel><runnables name="r">{items}</runnables><labels name="l"/></swModel>'


def test_labels_from_itea_files_have_a_boolean(up):
    result = up(
        '<swModel><labels name="a" buffered="true"/><labels name="b" buffered="false"/><labels name="c" buffered="odd"/></swModel>'
    )
    assert "labels dataStability='customProtection' name='a'" in result.lines
    assert "labels dataStability='noProtection' name='b'" in result.lines
    assert "labels dataStability='odd' name='c'" in result.lines


def test_two_mappings_of_a_section_to_one_memory_have_different_names(tmp_path):
    mapping = '<mapping t="SectionMapping" section="s?type=Section" memory="m?type=Memory"/>'
    result = migrate(
        tmp_path,
        "0.7.0",
        "0.7.2",
        '<swModel><sections name="s"/></swModel><hwModel><system name="h"><memories name="m"/></system></hwModel>'
        f"<mappingModel>{mapping}{mapping}</mappingModel>",
    )
    found = result.models.parts("mappingModel", "physicalSectionMapping")
    assert [made.name for made in found] == ["s_m", "s_m 2"]


@pytest.mark.parametrize(
    ("levels", "level"),
    [
        ('scheduleSectionLevel="true"', "scheduleSection"),
        ('scheduleSectionLevel="true" runnableLevel="true"', "runnable"),
        ('scheduleSectionLevel="true" processLevel="true" runnableLevel="false"', "process"),
    ],
)
def test_one_level_of_buffering_is_kept(up, levels, level):
    text = f'<osModel><osBuffering {levels}><customProperties key="k"/></osBuffering></osModel>'
    result = up(text)
    assert "osDataConsistency mode='automaticProtection'" in result.lines
    assert f"dataStability accessMultiplicity='multipleAccesses' enabled='true' level='{level}'" in result.lines
    assert "customProperties key='k'" in result.lines
    assert len(result.of("LOST")) == levels.count("true") - 1


def test_no_level_of_buffering_means_no_protection(up):
    result = up('<osModel><osBuffering runnableLevel="false" bufferingAlgorithm="a"/></osModel>')
    assert result.lines[2:] == ["osModel", "osDataConsistency mode='noProtection'"]
    assert ("LOST", "algorithm of osBuffering, which has no level", "a") in result.notes


def test_consistency_that_is_there_already_stays(up):
    assert up('<osModel><osDataConsistency mode="noProtection"/></osModel>').text.count("osDataConsistency") == 1
    assert (
        up("<osModel><operatingSystems><osDataConsistency/></operatingSystems></osModel>").text.count("osDataConsistency") == 1
    )
    result = up('<osModel><osBuffering processLevel="true"/><osDataConsistency mode="noProtection"/></osModel>')
    assert result.lines[2:] == ["osModel", "osDataConsistency mode='noProtection'"]
    assert result.of("LOST") == ["osBuffering: there is osDataConsistency, too"]


def test_instructions_are_wrapped_everywhere(up):
    result = up(
        runnable(
            '<runnableItems t="Group"><items><runnableItem t="Group"><items><runnableItem t="InstructionsConstant" value="1">'
            '<customProperties key="k"/></runnableItem></items></runnableItem></items></runnableItems>'
            '<runnableItems t="ProbabilityGroup"><items probability="5"><customProperties key="p"/>'
            '<runnableItem t="InstructionsConstant" value="2"><fetchStatistic/></runnableItem></items></runnableItems>'
            '<runnableItems t="RunnableModeSwitch"><entries><items t="InstructionsConstant" value="3"/></entries></runnableItems>'
        )
    )
    assert result.lines[3:] == [
        "labels name='l'",
        "runnables name='r'",
        "runnableItems [Group]",
        "items [Group]",
        "items [RunnableInstructions]",
        "customProperties key='k'",
        "default [InstructionsConstant] value='1'",
        "runnableItems [RunnableProbabilitySwitch]",
        "entries probability='5'",
        "customProperties key='p'",
        "items [RunnableInstructions]",
        "default [InstructionsConstant] value='2'",
        "fetchStatistic",
        "runnableItems [RunnableModeSwitch]",
        "entries",
        "items [RunnableInstructions]",
        "default [InstructionsConstant] value='3'",
    ]


OFFICIAL_ITEMS = (
    '<runnableItems t="InstructionsConstant" value="1"><customProperties key="k"/><fetchStatistic/></runnableItems>'
    '<runnableItems t="InstructionsDeviation"><customProperties key="k"/><deviation/></runnableItems>'
    '<runnableItems t="RunnableModeSwitch"><entries><items t="InstructionsConstant" value="3"/>'
    '<items t="LabelAccess" buffered="buffered"/></entries></runnableItems><runnableItems t="Group"><items>'
    '<runnableItem t="LabelAccess" buffered="buffered"/></items></runnableItems>'
)


def test_new_runnable_items_stay(up):
    items = (
        '<runnableItems t="RunnableInstructions"><default t="InstructionsConstant" value="1"/></runnableItems>'
        '<runnableItems t="Group"><items t="LabelAccess" data="l?type=Label"/></runnableItems><runnableItems t="ProbabilityGroup"/>'
    )
    result = up(runnable(items), source="0.7.2")
    assert result.lines[4:] == [
        "runnables name='r'",
        "runnableItems [RunnableInstructions]",
        "default [InstructionsConstant] value='1'",
        "runnableItems [Group]",
        "items [LabelAccess] data -> /swModel.0/labels.0",
        "runnableItems [RunnableProbabilitySwitch]",
    ]


def test_what_is_around_items_of_groups_is_not_lost_silently(up):
    text = runnable(
        '<runnableItems t="Group"><customProperties key="g"/><items><customProperties key="w"/><deviation>'
        '<lowerBound t="LongObject" value="4"/>'
        '</deviation><runnableItem t="LabelAccess"><statistic/></runnableItem></items><items/><items>'
        '<deviation samplingType="BestCase"/></items>'
        "</runnableItems>"
    )
    result = up(text)
    assert result.lines[4:] == [
        "runnables name='r'",
        "runnableItems [Group]",
        "customProperties key='g'",
        "items [LabelAccess]",
        "customProperties key='w'",
        "statistic",
    ]
    assert next(note for note in result.notes if note[0] == "LOST") == (
        "LOST",
        "deviation of an item of a group",
        "lowerBound (value=4)",
    )


DEVIATION = (
    '<stimuliModel><stimuli t="Periodic" name="p">'
    '<stimulusDeviation samplingType="WorstCase">{}</stimulusDeviation></stimuli></stimuliModel>'
)


@pytest.mark.parametrize(
    ("distribution", "kept"),
    [
        ('<distribution t="Boundaries"/>', True),
        ('<distribution t="UniformDistribution"/>', False),
        ("", True),
        ("<distribution/>", False),
    ],
)
def test_a_sampling_type_needs_boundaries(up, distribution, kept):
    result = up(DEVIATION.format(distribution))
    assert ("distribution [Boundaries] samplingType='WorstCase'" in result.lines) is kept
    assert bool(result.of("LOST")) is not kept


def test_instructions_of_the_operating_system_get_the_classes_of_runnables(up):
    result = up(
        '<osModel><osOverheads name="o"><apiOverhead><apiSetEvent t="OsExecutionInstructionsConstant" value="1"/></apiOverhead>'
        '<isrCategory1Overhead><preExecutionOverhead t="OsExecutionInstructionsDeviation"/></isrCategory1Overhead>'
        "</osOverheads></osModel>"
    )
    assert "apiSetEvent [InstructionsConstant] value='1'" in result.lines
    assert "preExecutionOverhead [InstructionsDeviation]" in result.lines


def test_small_renamings(up):
    result = up(
        '<swModel><processPrototypes name="p" preemption="unknown"/><isrs name="i" preemption="preemptive"/></swModel>'
        '<stimuliModel><stimuli t="ArrivalCurve" name="a"><arrivalCurveEntries numberOfOccurrences="1"/></stimuli></stimuliModel>'
    )
    assert "processPrototypes name='p'" in result.lines
    assert "isrs name='i' preemption='preemptive'" in result.lines
    assert "entries numberOfOccurrences='1'" in result.lines


AFFINITY = """
<constraintsModel>
  <affinityConstraints t="RunnablePairingConstraint"><runnables t="RunnableEntityGroup" runnables="r?type=Runnable"/>
    <runnables t="RunnableEntityGroup"/><target t="TargetProcess" processes="x?type=Task"/></affinityConstraints>
  <affinityConstraints t="ProcessPairingConstraint"><processes t="ProcessEntityGroup"/></affinityConstraints>
  <affinityConstraints t="DataPairingConstraint"><labels labels="l?type=Label"/></affinityConstraints>
  <affinityConstraints t="RunnableSeparationConstraint"><groups t="RunnableEntityGroup"/>
    <target t="TargetCallSequence" callSequences="c?type=CallSequence"/><target t="TargetCore"/></affinityConstraints>
</constraintsModel>
"""


def test_pairing_constraints_have_a_group(up):
    result = up(AFFINITY)
    assert [line for line in result.lines if line.startswith(("group", "runnables", "processes", "labels", "target"))] == [
        "group [RunnableEntityGroup] runnables -> ?r:Runnable",
        "group [RunnableEntityGroup]",
        "group [ProcessEntityGroup]",
        "group labels -> ?l:Label",
        "groups [RunnableEntityGroup]",
        "target [TargetCore]",
    ]
    assert [detail for kind, _, detail in result.notes if kind == "LOST"] == ["processes=x", "callSequences=c"]


def test_tags_of_one_name_are_one(up):
    result = up(
        '<swModel><tags name="t 1"/><tags name="u" tagType="a"/><runnables name="r" tags="t+1?type=Tag"/></swModel>'
        '<componentsModel><tags name="t 1"/><tags name="u" tagType="b"/>'
        '<components t="Component" name="c" tags="t+1?type=Tag u?type=Tag"/>'
        '</componentsModel><commonElements><tags name="u" tagType="a"/></commonElements>'
    )
    assert [line for line in result.lines if line.startswith("tags")] == ["tags name='u' tagType='a'", "tags name='t 1'"]
    assert "runnables name='r' tags -> /commonElements.0/tags.1" in result.lines
    assert "components [Component] name='c' tags -> /commonElements.0/tags.1 /commonElements.0/tags.0" in result.lines
    assert result.of("LOST") == ["a tag differs from another one of the same name, which is kept"]


def test_every_file_keeps_its_tags(up):
    result = up('<hwModel><tags name="t"/></hwModel>', '<swModel><runnables name="r" tags="t?type=Tag"/></swModel>')
    assert "runnables name='r' tags -> m0.amxmi/commonElements.0/tags.0" in result.lines


EVENTS = """
<configModel>
  <eventsToTrace t="EventConfigElement" name="own"><event t="LabelEvent" name="e"/></eventsToTrace>
  <eventsToTrace t="EventConfigElement" name="none"/>
  <eventsToTrace t="EventConfigLink" name="link" event="f?type=LabelEvent"/>
</configModel>
<constraintsModel><timingConstraints t="DelayConstraint" source="e?type=LabelEvent"/></constraintsModel>
"""


def test_traced_events_move_to_the_event_model(up):
    result = up(EVENTS)
    assert result.lines[2:] == [
        "configModel",
        "eventsToTrace name='own' event -> /eventModel.0/events.0",
        "eventsToTrace name='none'",
        "eventsToTrace name='link' event -> ?f:LabelEvent",
        "constraintsModel",
        "timingConstraints [DelayConstraint] source -> /eventModel.0/events.0",
        "eventModel",
        "events [LabelEvent] name='e'",
    ]
    assert result.of("LOST") == []


CONDITIONS = """
<propertyConstraintsModel>
  <allocationConstraints t="ProcessAllocationConstraint"><hwConstraint t="HwCoreConjunction">
    <firstConstraint t="HwCoreProperty"><core name="{core}" coreType="ct?type=CoreType"><memories name="inner"/></core>
    </firstConstraint>
    <secondConstraint t="HwCoreProperty"><core name="{core}"/></secondConstraint>
  </hwConstraint></allocationConstraints>
  <mappingConstraints t="AbstractElementMappingConstraint">
    <hwConstraint t="HwMemoryProperty"><memory name="inner"/></hwConstraint>
  </mappingConstraints>
  <coreTypeDefinitions name="ct" instructionsPerCycle="2"/>
</propertyConstraintsModel>
<mappingModel><coreAllocation core="{core}?type=Core"/></mappingModel>
"""


def test_new_hardware_of_constraints_moves_to_the_hardware_model(up):
    result = up(CONDITIONS.format(core="c 1").replace("c 1?", "c+1?"))
    core = "/hwModel.0/system.0/ecus.0/microcontrollers.0/cores.0"
    assert f"coreAllocation core -> {core}" in result.lines
    assert f"firstConstraint [HwCoreProperty] core -> {core}" in result.lines
    assert f"secondConstraint [HwCoreProperty] core -> {core}" in result.lines
    assert f"hwConstraint [HwMemoryProperty] memory -> {core}/memories.0" in result.lines
    assert "cores name='c 1' coreType -> /hwModel.0/coreTypes.0" in result.lines
    assert "ecus name='migration_gen_ecu'" in result.lines
    assert result.of("LOST") == []


def test_known_hardware_of_constraints_is_referred_to(up):
    hardware = """
    <hwModel><coreTypes name="ct"/><system name="s"><memories name="inner"/><ecus name="e"><microcontrollers name="m"><cores name="c"/>
    </microcontrollers></ecus></system></hwModel>
    """
    result = up(CONDITIONS.format(core="c"), hardware)
    core = "m1.amxmi/hwModel.0/system.0/ecus.0/microcontrollers.0/cores.0"
    assert f"coreAllocation core -> {core}" in result.lines
    assert f"firstConstraint [HwCoreProperty] core -> {core}" in result.lines
    assert "hwConstraint [HwMemoryProperty] memory -> m1.amxmi/hwModel.0/system.0/memories.0" in result.lines
    assert result.text.count("migration_gen") == 0
    assert len(result.of("LOST")) == 2  # the number of instructions of the type, and what the core contains


def test_new_cores_are_apart_from_those_of_the_system(up):
    hardware = '<hwModel><system name="s"><ecus name="e"><microcontrollers name="m"/></ecus></system></hwModel>'
    result = up(CONDITIONS.format(core="c"), hardware)
    assert "coreAllocation core -> m1.amxmi/hwModel.0/system.0/ecus.1/microcontrollers.0/cores.0" in result.lines
    assert "hwModel" not in result.text.split("== 0.7.2")[1].replace("/hwModel", "")


def test_a_condition_without_name_means_nothing(up):
    result = up(CONDITIONS.format(core=""))
    assert "firstConstraint [HwCoreProperty]" in result.lines
    assert len([message for message in result.of("LOST") if message.startswith("unnamed core")]) == 2


def test_damaged_files_are_no_problem(up):
    up(
        '<osModel><osBuffering/><osBuffering/></osModel><osModel/><target t="TargetProcess"/><core/><core name="x"/><tags/>'
        '<swModel><tags/><tags/><runnables><runnableItems t="Group"><items><runnableItem/><runnableItem/></items></runnableItems>'
        '<runnableItems t="ProbabilityGroup"><items/><items><runnableItem/></items></runnableItems></runnables></swModel>'
        '<propertyConstraintsModel><coreTypeDefinitions/><memoryTypeDefinitions name="m"/><memoryTypeDefinitions name="m"/>'
        '<allocationConstraints><hwConstraint t="HwCoreProperty"><core name="a"/><core name="b"/></hwConstraint>'
        "</allocationConstraints>"
        '</propertyConstraintsModel><configModel><eventsToTrace/><eventsToTrace t="EventConfigElement" event="x"/></configModel>'
        '<constraintsModel><affinityConstraints/><affinityConstraints t="DataPairingConstraint"/></constraintsModel>',
    )
