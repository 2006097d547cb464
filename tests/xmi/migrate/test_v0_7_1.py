"""0.7.0 -> 0.7.1: what the pairs of models do not show."""

import pytest
from inline_models import migrate

from amalthea_uros.xmi.migrate.steps.v0_7_1 import java_double


@pytest.fixture
def up(tmp_path):
    def run(*contents, root="Amalthea", source="0.7.0"):
        return migrate(tmp_path, source, "0.7.1", *contents, root=root)

    return run


@pytest.mark.parametrize(
    ("text", "double"),
    [
        ("200000000", "2.0E8"),
        ("792123456", "7.92123456E8"),
        ("100", "100.0"),
        ("0", "0.0"),
        ("10000000", "1.0E7"),
        ("9999999", "9999999.0"),
        ("-20000000", "-2.0E7"),
        ("many", "many"),
        ("1e999", "1e999"),
    ],
)
def test_frequencies_are_written_as_java_does(text, double):
    assert java_double(text) == double


@pytest.mark.parametrize(
    ("root", "tag"),
    [("HWModel", "hwModel"), ("CommonElements", "commonElements"), ("PropertyConstraintsModel", "propertyConstraintsModel")],
)
def test_a_root_that_is_a_sub_model_becomes_part_of_a_model(up, root, tag):
    result = up('<customProperties key="k"/>', root=root)
    assert result.lines == ["== 0.7.1", "Amalthea", tag, "customProperties key='k'"]
    assert result.of("CONVERTED") == ["part of a model as root of a file -> whole model"]


def test_references_by_position_survive_a_new_root(up):
    result = up(
        '<labels name="a"/><runnables name="r"><runnableItems t="LabelAccess" data="//@labels.0"/></runnables>', root="SWModel"
    )
    assert "runnableItems [LabelAccess] data -> /swModel.0/labels.0" in result.lines


def test_every_size_in_bits_gets_its_unit(up):
    size = '<size numberBits="8"/>'
    result = up(
        f'<swModel><tasks name="t">{size}</tasks><isrs name="i">{size}</isrs><customEntities name="c">{size}</customEntities>'
        f'<typeDefinitions t="BaseTypeDefinition" name="b">{size}</typeDefinitions><labels name="l"><size/></labels></swModel>'
    )
    assert result.lines.count("size unit='bit' value='8'") == 4
    assert "size" in result.lines


def test_a_quartz_in_a_quartz_gets_a_frequency_element(up):
    result = up(
        '<hwModel><system name="s"><quartzes name="q" frequency="5"><quartzes name="p" frequency="x"/></quartzes></system></hwModel>'
    )
    assert "frequency value='5.0'" in result.lines
    assert "frequency value='x'" in result.lines


def test_members_in_other_files_get_their_section(up):
    result = up(
        '<swModel><sections name="s 1"><labels href="amlt:/#l+1?type=Label"/><runEntities href="amlt:/#r?type=Runnable"/>'
        '<runEntities href="amlt:/#nowhere?type=Runnable"/></sections></swModel>',
        '<swModel><labels name="l 1"/><runnables name="r"/></swModel>',
    )
    assert "labels name='l 1' section -> m0.amxmi/swModel.0/sections.0" in result.lines
    assert "runnables name='r' section -> m0.amxmi/swModel.0/sections.0" in result.lines
    assert ("LOST", "member of a section that is in no file of the set", "nowhere") in result.notes


def test_a_member_of_another_kind_is_not_said_to_be_missing(up):
    result = up('<swModel><sections name="s" labels="t?type=Task"/><tasks name="t"/></swModel>')
    assert result.notes == [("LOST", "member of a section that is of another kind", "t")]


def test_a_second_section_is_reported(up):
    result = up(
        '<swModel><sections name="a" labels="l?type=Label"/><sections name="b" labels="l?type=Label"/><labels name="l"/></swModel>'
    )
    assert ("LOST", "another section of a label or runnable: only the first is kept", "b") in result.notes


MAPPED = """
<swModel><sections name="s"/></swModel><hwModel><system name="h"><memories name="m"/></system></hwModel>
<mappingModel>
  <mapping t="SectionMapping" section="s?type=Section" memory="m?type=Memory" memoryPositionAddress="64">
    <customProperties key="k"/>
  </mapping>
  <mapping t="SectionMapping" memory="m?type=Memory"/>
  <mapping t="AbstractElementMapping" memory="m?type=Memory"/>
</mappingModel>
"""


def test_the_mapping_of_a_section_is_kept(up):
    result = up(MAPPED)
    mapping = (
        "physicalSectionMapping startAddress='64' memory -> /hwModel.0/system.0/memories.0 origin -> /swModel.0/sections.0"
    )
    assert mapping in result.lines
    assert "customProperties key='k'" in result.lines
    assert result.of("LOST") == ["mapping of a section"]


SECTION_CONSTRAINTS = """
<propertyConstraintsModel>
  <mappingConstraints t="SectionMappingConstraint" section="s?type=Section">
    <hwConstraint t="HwMemoryProperty" comparator="equal"><memory name="m"/></hwConstraint>
  </mappingConstraints>
  <mappingConstraints t="SectionMappingConstraint" section="s?type=Section"/>
</propertyConstraintsModel><swModel><sections name="s"/></swModel>
"""


def test_constraints_of_sections_are_kept_as_text_if_they_constrain_anything(up):
    result = up(SECTION_CONSTRAINTS)
    assert "mappingConstraints [" not in result.text
    assert (
        "customProperties key='SectionMappingConstraint (element removed during Migration of Model to 0.7.1 version)'"
        in result.lines
    )
    assert '<memory name="m" />' in result.text
    assert result.of("KEPT") == result.of("LOST") == ["constraint for the mapping of a section"]


SWITCH = """
<swModel><{process} name="t"><callGraph><graphEntries t="ModeSwitch">
  <entries {first}><value href="amlt:/#m/a?type=ModeLiteral"/><graphEntries t="ProbabiltitySwitch">
    <entries probability="1"><graphEntries t="ModeSwitch"><entries value="m/a?type=ModeLiteral" default="true"/>
    </graphEntries></entries>
  </graphEntries></entries>
  <entries {second}/>
</graphEntries></callGraph></{process}><modes name="m"><literals name="a"/></modes></swModel>
"""


@pytest.mark.parametrize("process", ["tasks", "isrs"])
def test_switches_inside_of_switches_are_changed(up, process):
    result = up(SWITCH.format(process=process, first="", second='default="true"'))
    assert "graphEntries [ModeSwitch]" in result.lines
    assert "items [ProbabiltitySwitch]" in result.lines
    assert "items [ModeSwitch]" in result.lines
    assert "entries values -> /swModel.0/modes.0/literals.0" in result.lines
    assert result.lines.count("defaultEntry") == 2


def test_only_true_makes_an_entry_the_default_one(up):
    text = SWITCH.format(process="tasks", first='default="true"', second='default="true"')
    assert up(text).of("LOST") == ["second default entry of a mode switch: it is an ordinary entry now"]
    text = SWITCH.format(process="tasks", first='default="false"', second='default="false"')
    assert up(text).lines.count("defaultEntry") == 1


def test_entries_of_anything_else_are_not_those_of_switches(up):
    entries = '<entries value="m/a?type=ModeLiteral"/>'
    result = up(
        f'<stimuliModel><stimuli t="Periodic" name="p"><setModeValueList>{entries}</setModeValueList></stimuli></stimuliModel>'
    )
    assert "entries value -> ?m/a:ModeLiteral" in result.lines


CONSTRAINTS = """
<constraintsModel>
  <eventChains name="e"/>
  <timingConstraints t="AgeConstraint" name="age" scope="e?type=EventChain"><maximum value="5" unit="s"/></timingConstraints>
  <timingConstraints t="ReactionConstraint" name="reaction"/>
  <timingConstraints t="DelayConstraint" name="delay"/>
  <timingConstraints t="SynchronisationConstraint" name="sync" events="l?type=LabelEvent"/>
  <timingConstraints t="OrderConstraint" name="order" source="l?type=LabelEvent" target="l?type=LabelEvent"/>
  <affinityConstraints t="SchedulerPairingConstraint" name="pair"><schedulers schedulers="s?type=TaskScheduler"/></affinityConstraints>
  <affinityConstraints t="SchedulerSeparationConstraint" name="apart"/>
</constraintsModel>
<eventModel><events t="LabelEvent" name="l"/></eventModel>
"""


def test_timing_constraints_get_new_classes(up):
    result = up(CONSTRAINTS)
    constraint = "timingConstraints [EventChainLatencyConstraint]"
    assert f"{constraint} name='age' type='Age' scope -> /constraintsModel.0/eventChains.0" in result.lines
    assert f"{constraint} name='reaction' type='Reaction'" in result.lines
    assert "timingConstraints [DelayConstraint] mappingType='Reaction' name='delay'" in result.lines
    assert "timingConstraints [EventSynchronizationConstraint] name='sync' events -> /eventModel.0/events.0" in result.lines
    assert "[OrderConstraint]" not in result.text
    assert not any(line.startswith("affinityConstraints") for line in result.lines)
    assert len(result.of("KEPT")) == 3
    assert "customProperties" in result.text


def test_removed_constraints_are_kept_with_the_names_of_what_they_mean(up):
    result = up(CONSTRAINTS)
    assert 'source="l?type=LabelEvent" target="l?type=LabelEvent" />' in result.text
    assert '<schedulers schedulers="s?type=TaskScheduler" />' in result.text


SEQUENCE = """
<swModel><runnables name="a"/><runnables name="b"/><processPrototypes name="p"/></swModel>
<constraintsModel><runnableSequencingConstraints name="s">
  <runnableGroups groupingType="{grouping}">
    <entries runnable="a?type=Runnable" processScope="p?type=ProcessPrototype"/>
    <entries runnable="b?type=Runnable"{scope}/>
    <entries runnable="b?type=Runnable"{scope}/>
  </runnableGroups>
</runnableSequencingConstraints></constraintsModel>
"""


def test_groups_refer_to_runnables(up):
    result = up(SEQUENCE.format(grouping="allOfThem", scope=' processScope="p?type=ProcessPrototype"'))
    assert "runnableGroups runnables -> /swModel.0/runnables.0 /swModel.0/runnables.1" in result.lines
    assert not any(line.startswith("entries") for line in result.lines)
    assert "runnableSequencingConstraints name='s' processScope -> /swModel.0/processPrototypes.0" in result.lines
    assert result.of("LOST") == []


def test_scopes_that_differ_and_groupings_are_lost(up):
    result = up(SEQUENCE.format(grouping="atLeastOneOfThem", scope=""))
    assert "runnableSequencingConstraints name='s'" in result.lines
    assert sorted(message.split(" ")[0] for message in result.of("LOST")) == ["grouping", "scopes"]


SCOPED = """
<swModel><runnables name="a"/><processPrototypes name="p"/><processPrototypes name="q"/></swModel>
<constraintsModel><runnableSequencingConstraints name="s"{}><runnableGroups><entries runnable="a?type=Runnable"{}/></runnableGroups>
</runnableSequencingConstraints></constraintsModel>
"""


def test_the_scope_of_a_constraint_is_not_widened(up):
    scope = ' processScope="{}?type=ProcessPrototype"'
    result = up(SCOPED.format(scope.format("q"), scope.format("p")))
    assert "runnableSequencingConstraints name='s' processScope -> /swModel.0/processPrototypes.1" in result.lines
    assert ("LOST", "scopes of single runnables in a sequencing constraint", "p") in result.notes
    result = up(SCOPED.format("", scope.format("p")))
    assert ("MOVED", "processScope of all entries -> processScope of the constraint", "p") in result.notes


def test_of_an_entry_without_scope_nothing_is_lost_but_what_is_not_known(up):
    assert up(SCOPED.format("", "")).of("LOST") == []
    assert ("LOST", "content of an entry of a group of runnables", "x=1") in up(SCOPED.format("", ' x="1"')).notes


def test_the_stated_mapping_of_a_delay_constraint_stays(up):
    content = '<constraintsModel><timingConstraints t="DelayConstraint"{}/></constraintsModel>'
    assert up(content.format(' mappingType="OneToOne"')).notes == []
    assert up(content.format("")).of("DEFAULTED") == ["mappingType of a delay constraint: Reaction is what 0.7.0 meant"]


def test_a_file_of_the_next_version_with_old_constraints_takes_the_step_and_keeps_the_rest(up):
    new = (
        '<hwModel><memoryTypes name="m"><size value="1" unit="kB"/></memoryTypes></hwModel><swModel>'
        '<labels name="l" section="s?type=Section"/>'
    )
    result = up(new + '<sections name="s"/></swModel>' + CONSTRAINTS, source="0.7.1")
    assert "size unit='kB' value='1'" in result.lines
    assert "labels name='l' section -> /swModel.0/sections.0" in result.lines
    assert "timingConstraints [EventChainLatencyConstraint] name='reaction' type='Reaction'" in result.lines


def test_damaged_files_are_no_problem(up):
    up(
        '<swModel><sections labels="x"/><sections labels="s?type=Section" runEntities="t?type=Task"/><tasks name="t"><callGraph>'
        '<graphEntries t="ModeSwitch"><entries value="x" default=""/><entries/></graphEntries><entries value="1"/>'
        "</callGraph></tasks></swModel>"
        '<hwModel><memoryTypes size=""/><memoryTypes size="x"><size value="1"/></memoryTypes><quartzes frequency=""/></hwModel>'
        '<mappingModel><mapping/><mapping t="SectionMapping" section="x" memory="y"/></mappingModel>'
        "<constraintsModel><timingConstraints/><affinityConstraints/><runnableSequencingConstraints><runnableGroups>"
        '<entries runnable="x"/>'
        '<entries processScope="y"><z/></entries></runnableGroups></runnableSequencingConstraints></constraintsModel>'
        '<timingConstraints t="OrderConstraint"/>',
    )
