"""0.8.2 -> 0.8.3, as far as the pairs of models do not show it."""

from functools import partial

import pytest
from inline_models import check_early, check_step, check_twice, damaged, of_kind, text_property, written
from migration import migrated

from amalthea_uros.xmi.tree.notes import NoteKind


@pytest.fixture
def files(tmp_path):
    """Write files of a version."""
    return partial(written, tmp_path)


@pytest.fixture
def same(tmp_path):
    """Assert what some files become."""
    return partial(check_step, tmp_path, "0.8.2", "0.8.3")


# Stimuli

DEVIATION = (
    '<{0}><lowerBound t="Time" value="1" unit="ms"/><upperBound t="Time" value="3" unit="ms"/>'
    '<distribution t="WeibullEstimators" pRemainPromille="0.5"><mean t="Time" value="2" unit="ms"/>'
    "</distribution></{0}>"
)
KEPT = "lowerBound=1ms, upperBound=3ms, distribution=WeibullEstimators(pRemainPromille=0.5, mean=2ms)"


@pytest.mark.parametrize(
    "kind", ["CustomStimulus", "EventStimulus", "InterProcessStimulus", "SingleStimulus", "ArrivalCurveStimulus"]
)
def test_a_deviation_without_successor_is_kept_as_custom_property(same, kind):
    model = '<stimuliModel><stimuli t="' + kind + '" name="S">{}</stimuli></stimuliModel>'
    before = model.format(DEVIATION.format("stimulusDeviation"))
    notes = same(before, model.format(text_property("stimulusDeviation", KEPT)))
    assert not of_kind(notes, NoteKind.LOST)


def test_variable_rate_activations_have_no_deviation_but_sporadic_ones_do(same):
    model = '<swModel><activations t="VariableRateActivation" name="V">{}</activations>'
    model += f'<activations t="SporadicActivation" name="S">{DEVIATION.format("activationDeviation")}</activations></swModel>'
    before = model.format(DEVIATION.format("activationDeviation"))
    same(before, model.format(text_property("activationDeviation", KEPT)))


def test_what_a_clocked_stimulus_loses_is_noted(files):
    text = '<stimuliModel><stimuli t="PeriodicStimulus" name="P" clock="c?type=ClockSinusFunction">'
    text += '<offset value="1" unit="s"/>'
    text += f'{DEVIATION.format("stimulusDeviation")}</stimuli><clocks t="ClockSinusFunction" name="c"/></stimuliModel>'
    _, notes = migrated(files("0.8.2", text), "0.8.3")
    assert of_kind(notes, NoteKind.LOST) == [("deviation of a periodic stimulus with a clock", KEPT)]
    assert of_kind(notes, NoteKind.KEPT) == [("offset of a periodic stimulus with a clock", "1s")]


# Mode switches

MODES = '<swModel><modes name="M"><literals name="a"/><literals name="b"/></modes><modeLabels name="L"/>{}</swModel>'
ONE = '<condition><entries t="ModeValue" valueProvider="L?type=ModeLabel" value="M/a?type=ModeLiteral"/></condition>'


@pytest.mark.parametrize("tag", ["tasks", "isrs"])
def test_switches_in_switches(same, tag):
    graph = f'<{tag} name="T"><callGraph><graphEntries t="ProbabilitySwitch"><entries><items t="ModeSwitch"{{0}}>'
    graph += '<defaultEntry><items t="ModeSwitch"{0}><entries name="e"{1}{2}</items></defaultEntry></items></entries>'
    graph += f"</graphEntries></callGraph></{tag}>"
    before = graph.format(' valueProvider="L?type=ModeLabel"', ' values="M/a?type=ModeLiteral"', "/>")
    notes = same(MODES.format(before), MODES.format(graph.format("", "", f">{ONE}</entries>")))
    assert of_kind(notes, NoteKind.LOST) == [("mode label of a switch without entries", "L?type=ModeLabel")]


RUNNABLE = '<runnables name="R"><runnableItems t="RunnableModeSwitch"><defaultEntry><items t="RunnableModeSwitch"{}'
RUNNABLE += "</items></defaultEntry></runnableItems></runnables>"


def test_a_switch_in_the_default_of_a_switch_of_a_runnable(same):
    before = RUNNABLE.format(' valueProvider="L?type=ModeLabel"><entries values="M/a?type=ModeLiteral"/>')
    same(MODES.format(before), MODES.format(RUNNABLE.format(f"><entries>{ONE}</entries>")))


def test_labels_and_literals_of_other_files(same):
    task = '<swModel><tasks name="T"><callGraph><graphEntries t="ModeSwitch">{}</graphEntries></callGraph></tasks></swModel>'
    label = '<valueProvider href="amlt:/#L?type=ModeLabel"/>'
    before = task.format(f'{label}<entries><values href="amlt:/#M/a?type=ModeLiteral"/></entries>')
    after = '<entries><condition><entries t="ModeValue">{}<value href="amlt:/#M/a?type=ModeLiteral"/></entries></condition>'
    after = task.format(f"{after}</entries>")
    modes = MODES.format("")
    same([before, modes], [after.format(label), modes])


def test_a_literal_of_a_mode_in_no_file_is_not_taken_for_one_of_the_same_name(files):
    task = '<tasks name="T"><callGraph><graphEntries t="ModeSwitch" valueProvider="L?type=ModeLabel"><entries>'
    task += (
        '<values href="amlt:/#M/a?type=ModeLiteral"/><values href="amlt:/#Other/a?type=ModeLiteral"/></entries></graphEntries>'
    )
    models, _ = migrated(files("0.8.2", MODES.format(f"{task}</callGraph></tasks>")), "0.8.3")
    targets = [node.target("value") for node in models.walk() if node.type == "ModeValue"]
    assert [target.is_proxy for target in targets] == [False, True]


# Components


def test_interface_ports_and_references_to_them(same):
    model = '<componentsModel><components name="C"><ports t="{0}" name="p" kind="provides"/></components><systems>'
    model += (
        '<connectors><sourcePort port="C/p?type={0}"/><targetPort><port href="amlt:/#D/q?type={0}"/></targetPort></connectors>'
    )
    model += '<groundedPorts port="C/p?type={0}"/></systems></componentsModel>'
    same(model.format("FInterfacePort"), model.format("InterfacePort"))


# Leftovers and damage

EVERYTHING = (
    '<stimuliModel><stimuli t="PeriodicStimulus" name="P" clock="c?type=ClockSinusFunction"><offset value="1" unit="s"/>'
    f'<recurrence value="2" unit="s"/>{DEVIATION.format("stimulusDeviation")}</stimuli>'
    f'<stimuli t="PeriodicStimulus" name="Q">{DEVIATION.format("stimulusDeviation")}</stimuli>'
    f'<stimuli t="SporadicStimulus" name="S">{DEVIATION.format("stimulusDeviation")}</stimuli>'
    f'<stimuli t="CustomStimulus" name="U">{DEVIATION.format("stimulusDeviation")}</stimuli>'
    '<stimuli t="SyntheticStimulus" name="Y"><period value="9" unit="ms"/><triggerTimes><timestamps value="1" unit="ms"/>'
    '</triggerTimes></stimuli><stimuli t="SingleStimulus" name="X"><activation value="3" unit="ms"/></stimuli>'
    '<stimuli t="ArrivalCurveStimulus" name="A"><entries numberOfEvents="2"/></stimuli>'
    '<clocks t="ClockSinusFunction" name="c"/></stimuliModel>'
    + MODES.format(
        RUNNABLE.format(' valueProvider="L?type=ModeLabel"><entries values="M/a?type=ModeLiteral M/b?type=ModeLiteral"/>')
        + f'<activations t="VariableRateActivation" name="V">{DEVIATION.format("activationDeviation")}</activations>'
    )
    + '<componentsModel><components name="C"><ports t="FInterfacePort" name="p"/></components></componentsModel>'
)


def test_a_file_whose_namespace_was_raised_early_takes_the_step(tmp_path):
    check_early(tmp_path, "0.8.2", "0.8.3", "0.8.3", EVERYTHING)


def test_the_step_leaves_alone_what_is_converted(tmp_path):
    check_twice(tmp_path, "0.8.2", "0.8.3", EVERYTHING)


def test_damaged_files_are_migrated(files):
    values = ["", "0", "x", "P?type=PeriodicStimulus", "M/a?type=ModeLiteral", "gone?type=ModeLabel gone?type=Core"]
    for text in damaged(EVERYTHING, values, seed=3):
        migrated(files("0.8.2", text), "0.8.3")
