"""0.8.0 -> 0.8.1, as far as the pairs of models do not show it."""

import pytest
from inline_models import of_kind, text_property
from migration import migrated

from amalthea_uros.xmi.tree.notes import NoteKind

#: The versions.
STEP = ("0.8.0", "0.8.1")


# Priorities


def test_the_task_may_be_in_a_file_of_a_later_version(files):
    newer = files("0.8.1", f'<swModel><tasks name="A">{text_property("priority", 5)}</tasks></swModel>')
    older = files(
        "0.8.0", '<mappingModel><taskAllocation priority="0"><task href="amlt:/#A?type=Task"/></taskAllocation></mappingModel>'
    )
    models, _ = migrated([*newer, *older], "0.8.1")
    (allocation,) = models.trees[1].root.find("mappingModel", "taskAllocation")
    assert not allocation.children


@pytest.mark.parametrize(("attribute", "parameter"), [("priority", "priority"), ("osekTaskGroup", "taskGroup")])
def test_a_custom_property_that_was_there_is_not_taken_for_what_the_task_states(files, attribute, parameter):
    models, notes = migrated(
        files(
            "0.8.0",
            f'<swModel><tasks name="T" {attribute}="5">{text_property(attribute, 7)}</tasks></swModel><osModel>'
            '<operatingSystems name="O"><taskSchedulers name="S"><schedulingAlgorithm t="OSEK"/></taskSchedulers>'
            "</operatingSystems></osModel><mappingModel>"
            '<taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/></mappingModel>',
        ),
        "2.0.0",
    )
    (stated,) = models.parts("mappingModel", "taskAllocation", "schedulingParameters")
    assert (stated.target("key").name, stated.child("value").get("value")) == (parameter, "5")
    (kept,) = models.parts("swModel", "tasks", "customProperties")
    assert (kept.get("key"), kept.child("value").get("value")) == (f"{attribute} 2", "7")
    assert f"{attribute} 2" in dict(reversed(pair) for pair in of_kind(notes, NoteKind.RENAMED))


# Stimuli

CALLS = '<callGraph><graphEntries t="CallSequence"><calls t="{}"{}</graphEntries></callGraph>'


@pytest.mark.parametrize("tag", ["tasks", "isrs"])
def test_a_trigger_of_another_kind_of_stimulus_keeps_it_as_custom_property(same, tag):
    stimuli = '<stimuliModel><stimuli t="Single{}" name="S"/></stimuliModel>'
    before = CALLS.format("InterProcessActivation", ' stimulus="S?type=Single"/>')
    kept = '<customProperties key="stimulus"><value t="ReferenceObject" value="S?type=SingleStimulus"/></customProperties>'
    after = CALLS.format("InterProcessTrigger", f">{kept}</calls>")
    same(
        f'<swModel><{tag} name="T">{before}</{tag}></swModel>{stimuli.format("")}',
        f'<swModel><{tag} name="T">{after}</{tag}></swModel>{stimuli.format("Stimulus")}',
    )


# Schedulers

SYSTEM = '<osModel><operatingSystems name="OS">{}</operatingSystems></osModel>'


@pytest.mark.parametrize("tag", ["taskSchedulers", "interruptControllers"])
def test_scheduling_units(same, tag):
    notes = same(
        SYSTEM.format(
            f'<{tag} name="S" scheduleUnitPriority="0"><schedulingUnit t="SchedulingSWUnit" priority="0" '
            f'interruptController="C?type=InterruptController">{text_property("k", "v")}'
            '<instructions t="InstructionsDeviation"><deviation/></instructions></schedulingUnit></'
            f'{tag}><{tag} name="H"><schedulingUnit t="SchedulingHWUnit">{text_property("k", "v")}</schedulingUnit></{tag}>'
            '<interruptControllers name="C"/>'
        ),
        SYSTEM.format(
            f'<{tag} name="S">{text_property("SchedulingSWUnit_CustomProperty__k", "v")}'
            '<computationItems t="RunnableInstructions"><default t="InstructionsDeviation"><deviation/></default>'
            f'</computationItems></{tag}><{tag} name="H">{text_property("SchedulingHWUnit_CustomProperty__k", "v")}</{tag}>'
            '<interruptControllers name="C"/>'
        ),
    )
    assert of_kind(notes, NoteKind.LOST) == [("interrupt controller of a scheduling unit", "C?type=InterruptController")]


# Event chains


def test_process_prototypes_have_priorities_and_custom_properties_come_first(files):
    stated = f'<processPrototypes name="P" priority="2">{text_property("k", "v")}<runnableCalls/></processPrototypes>'
    models, _ = migrated(files("0.8.0", f"<swModel>{stated}</swModel>"), "0.8.1")
    (prototype,) = models.trees[0].root.find("swModel", "processPrototypes")
    assert [child.tag for child in prototype.children] == ["customProperties", "customProperties", "runnableCalls"]
    assert [child.get("key") for child in prototype.all("customProperties")] == ["k", "priority"]


def test_the_name_of_an_inner_chain_means_the_outer_one_that_shares_it(files):
    model = '<constraintsModel><eventChains name="a"><segments t="SubEventChain"><eventChain name="b"/></segments>'
    model += '<segments t="EventChainReference" eventChain="b?type=EventChain"/></eventChains><eventChains name="b"/>'
    models, _ = migrated(files("0.8.0", model + "</constraintsModel>"), "0.8.1")
    first, second = models.trees[0].root.find("constraintsModel", "eventChains")
    assert first.children[1].references == {"eventChain": [second]}
