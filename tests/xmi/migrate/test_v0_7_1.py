"""0.7.0 -> 0.7.1: what the pairs of models do not show."""

import pytest

from amalthea_uros.xmi.migrate.steps.v0_7_1 import java_double

#: The versions.
STEP = ("0.7.0", "0.7.1")


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


def test_removed_constraints_are_kept_with_the_names_of_what_they_mean(up):
    result = up(CONSTRAINTS)
    assert 'source="l?type=LabelEvent" target="l?type=LabelEvent" />' in result.text
    assert '<schedulers schedulers="s?type=TaskScheduler" />' in result.text


SCOPED = """
<swModel><runnables name="a"/><processPrototypes name="p"/><processPrototypes name="q"/></swModel>
<constraintsModel><runnableSequencingConstraints name="s"{}><runnableGroups><entries runnable="a?type=Runnable"{}/></runnableGroups>
</runnableSequencingConstraints></constraintsModel>
"""


def test_of_an_entry_without_scope_nothing_is_lost_but_what_is_not_known(up):
    assert up(SCOPED.format("", "")).of("LOST") == []
    assert ("LOST", "content of an entry of a group of runnables", "x=1") in up(SCOPED.format("", ' x="1"')).notes


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
