"""0.8.2 -> 0.8.3, as far as the pairs of models do not show it."""

import pytest
from inline_models import of_kind, text_property
from migration import migrated

from amalthea_uros.xmi.tree.notes import NoteKind

#: The versions.
STEP = ("0.8.2", "0.8.3")


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


def test_a_literal_of_a_mode_in_no_file_is_not_taken_for_one_of_the_same_name(files):
    task = '<tasks name="T"><callGraph><graphEntries t="ModeSwitch" valueProvider="L?type=ModeLabel"><entries>'
    task += (
        '<values href="amlt:/#M/a?type=ModeLiteral"/><values href="amlt:/#Other/a?type=ModeLiteral"/></entries></graphEntries>'
    )
    models, _ = migrated(files("0.8.2", MODES.format(f"{task}</callGraph></tasks>")), "0.8.3")
    targets = [node.target("value") for node in models.walk() if node.type == "ModeValue"]
    assert [target.is_proxy for target in targets] == [False, True]
