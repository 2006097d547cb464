"""Activity graphs and interfaces of components."""

import pytest
from inline_models import InlineModels

from amalthea_uros.xmi.migrate.notes import NoteKind


@pytest.fixture
def models(tmp_path):
    return InlineModels(tmp_path)


def test_interface_ports_become_ports_that_refer_to_interfaces(models):
    software = """<swModel><tasks name="T"/><runnables name="R"><{graph}>
        <items t="SenderReceiverRead" port="{port}"/></{graph}></runnables></swModel>"""
    before = (
        software.format(graph="callGraph", port="p?type=InterfacePort")
        + """<componentsModel>
      <components name="C 1" tasks="T?type=Task">
        <ports t="InterfacePort" name="p" interfaceName="Speed value" kind="provides"/>
        <ports t="InterfacePort" name="q" kind="requires"/></components>
      <components t="Composite" name="D">
        <ports t="InterfacePort" name="r" interfaceName="Speed value" kind="requires"/>
        <connectors name="x"><sourcePort port="p?type=InterfacePort"/><targetPort port="r?type=InterfacePort"/></connectors>
      </components></componentsModel>"""
    )
    after = (
        software.format(graph="activityGraph", port="C+1/p?type=ComponentPort")
        + """<componentsModel>
      <components name="C 1" processes="T?type=Task">
        <ports name="p" kind="provides" interface="Speed+value?type=MainInterface"/>
        <ports name="q" kind="requires"/></components>
      <components t="Composite" name="D">
        <ports name="r" kind="requires" interface="Speed+value?type=MainInterface"/>
        <connectors name="x"><sourcePort port="C+1/p?type=ComponentPort"/><targetPort port="D/r?type=ComponentPort"/></connectors>
      </components><interfaces name="Speed value"/></componentsModel>"""
    )
    assert models.migrate("0.9.6", "0.9.7", before) == models.read("0.9.7", after)
    assert models.messages(NoteKind.LOST) == []


def test_an_interface_may_be_in_another_file(models):
    component = """<componentsModel><components name="C">
        <ports {} name="p" kind="provides"{}</components>{}</componentsModel>"""
    one = component.format('t="InterfacePort"', ' interfaceName="I"/>', "")
    first = component.format("", ' interface="I?type=MainInterface"/>', '<interfaces name="I"/>')
    second = component.format("", '><interface href="amlt:/#I?type=MainInterface"/></ports>', "")
    assert models.migrate("0.9.6", "0.9.7", one, one) == models.read("0.9.7", first, second)


def test_ports_in_no_file_keep_their_name(models):
    text = '<componentsModel><systems name="S"><groundedPorts port="{}"/></systems></componentsModel>'
    found = models.migrate("0.9.6", "0.9.7", text.format("p?type=InterfacePort"))
    assert found == models.read("0.9.7", text.format("p?type=ComponentPort"))


def test_two_graphs_of_a_process_become_one(models):
    before = """<swModel><tasks name="T"><activityGraph><items t="SchedulePoint"/></activityGraph>
      <callGraph><items t="Group" name="g"/></callGraph></tasks></swModel>"""
    after = """<swModel><tasks name="T"><activityGraph><items t="SchedulePoint"/>
      <items t="Group" name="g"/></activityGraph></tasks></swModel>"""
    assert models.migrate("0.9.6", "0.9.7", before) == models.read("0.9.7", after)


def test_what_is_mandatory_now_is_to_be_checked_and_not_invented(models):
    content = """<swModel><activations t="SingleActivation" name="A"><min value="1" unit="ms"/></activations></swModel>
      <stimuliModel><stimuli t="PeriodicStimulus" name="P"/>
        <stimuli t="RelativePeriodicStimulus" name="R"/>
        <stimuli t="VariableRateStimulus" name="V"/></stimuliModel>
      <componentsModel><systems name="S"><connectors name="x"><sourcePort/></connectors></systems></componentsModel>"""
    assert models.migrate("0.9.6", "0.9.7", content) == models.read("0.9.7", content)
    assert sorted(message.partition(",")[0] for message in models.messages(NoteKind.TO_CHECK)) == [
        "PeriodicStimulus without recurrence",
        "RelativePeriodicStimulus without nextOccurrence",
        "SingleActivation without max",
        "VariableRateStimulus without occurrencesPerStep",
        "sourcePort without port",
    ]
