"""0.8.0 -> 0.8.1, as far as the pairs of models do not show it."""

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
    return partial(check_step, tmp_path, "0.8.0", "0.8.1")


# Priorities


def test_a_custom_property_that_says_the_same_is_enough(same):
    model = f'<swModel><tasks name="T"{{}}>{text_property("priority", 5)}{text_property("osekTaskGroup", 2)}</tasks></swModel>'
    same(model.format(' priority="5" osekTaskGroup="2"'), model.format(""))


def test_what_becomes_of_priorities_and_groups_is_noted(files):
    content = '<swModel><tasks name="A" priority="5" osekTaskGroup="0"/><tasks name="B" priority="0" osekTaskGroup="2"/>'
    content += '<isrs name="I" priority="9"/></swModel><mappingModel><taskAllocation task="B?type=Task" priority="3"/>'
    content += '<isrAllocation isr="I?type=ISR" priority="0"/></mappingModel>'
    _, notes = migrated(files("0.8.0", content), "0.8.1")
    assert [(note.kind.name, note.message, note.detail) for note in notes] == [
        ("MOVED", "priority of a task allocation -> schedulingParameters", "3"),
        ("CONVERTED", "priority 0, the old default, replaced: the priority of the ISR applies", "9"),
        ("KEPT", "priority of a process", "5"),
        ("CONVERTED", "priority 0, the old default, left out: the priority of the allocation applies", ""),
        ("KEPT", "priority of a process", "9"),
        ("CONVERTED", "OSEK task group 0, the old default, left out", ""),
        ("KEPT", "OSEK task group", "2"),
    ]


def test_the_task_may_be_in_a_file_of_a_later_version(files):
    newer = files("0.8.1", f'<swModel><tasks name="A">{text_property("priority", 5)}</tasks></swModel>')
    older = files(
        "0.8.0", '<mappingModel><taskAllocation priority="0"><task href="amlt:/#A?type=Task"/></taskAllocation></mappingModel>'
    )
    models, _ = migrated([*newer, *older], "0.8.1")
    (allocation,) = models.trees[1].root.find("mappingModel", "taskAllocation")
    assert not allocation.children


def test_process_prototypes_have_priorities_and_custom_properties_come_first(files):
    models, _ = migrated(
        files(
            "0.8.0",
            f'<swModel><processPrototypes name="P" priority="2">{text_property("k", "v")}<runnableCalls/></processPrototypes>'
            "</swModel>",
        ),
        "0.8.1",
    )
    (prototype,) = models.trees[0].root.find("swModel", "processPrototypes")
    assert [child.tag for child in prototype.children] == ["customProperties", "customProperties", "runnableCalls"]
    assert [child.get("key") for child in prototype.all("customProperties")] == ["k", "priority"]


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


def test_what_becomes_of_scheduling_units_is_noted(files):
    schedulers = f'<taskSchedulers name="S" scheduleUnitPriority="0"><schedulingUnit priority="3">{text_property("k", "v")}'
    schedulers += '<instructions t="InstructionsConstant" value="1"/></schedulingUnit></taskSchedulers>'
    schedulers += (
        f'<taskSchedulers name="H"><schedulingUnit>{text_property("k", "v")}<delay value="1" unit="ns"/></schedulingUnit>'
    )
    models, notes = migrated(files("0.8.0", SYSTEM.format(f"{schedulers}</taskSchedulers>")), "0.8.1")
    keys = [[each.get("key") for each in found.all("customProperties")] for found in models.nodes("taskSchedulers")]
    assert keys == [
        ["SchedulingSWUnit_CustomProperty__k", "SchedulingSWUnit___priority"],
        ["SchedulingHWUnit_CustomProperty__k", "SchedulingHWUnit___delay"],
    ]
    assert [(note.kind.name, note.message, note.detail) for note in notes] == [
        ("CONVERTED", "scheduleUnitPriority 0, the old default, left out", ""),
        ("MOVED", "custom property of a scheduling unit -> scheduler", "SchedulingSWUnit_CustomProperty__k"),
        ("MOVED", "instructions of a scheduling unit -> computationItems of the scheduler", ""),
        ("KEPT", "priority of a scheduling unit", "3"),
        ("MOVED", "custom property of a scheduling unit -> scheduler", "SchedulingHWUnit_CustomProperty__k"),
        ("KEPT", "delay of a scheduling unit", "1ns"),
    ]


# Event chains

OUTER = '<eventChains name="outer"><{0} t="{1}"><eventChain name="inner"/></{0}></eventChains>'


def test_references_to_inner_chains_are_noted(files):
    model = OUTER.format("segments", "SubEventChain") + '<eventChains name="c"><strands t="EventChainReference" '
    model += 'eventChain="inner?type=EventChain"/></eventChains>'
    model += '<timingConstraints t="EventChainLatencyConstraint" name="l" scope="inner?type=EventChain"/>'
    _, notes = migrated(files("0.8.0", f"<constraintsModel>{model}</constraintsModel>"), "0.8.1")
    assert of_kind(notes, NoteKind.KEPT) == [
        ("reference to an inner event chain", "inner?type=EventChain"),
        ("scope: reference to an inner event chain", "inner?type=EventChain"),
    ]


def test_the_name_of_an_inner_chain_means_the_outer_one_that_shares_it(files):
    model = '<constraintsModel><eventChains name="a"><segments t="SubEventChain"><eventChain name="b"/></segments>'
    model += '<segments t="EventChainReference" eventChain="b?type=EventChain"/></eventChains><eventChains name="b"/>'
    models, _ = migrated(files("0.8.0", model + "</constraintsModel>"), "0.8.1")
    first, second = models.trees[0].root.find("constraintsModel", "eventChains")
    assert first.children[1].references == {"eventChain": [second]}


# Leftovers and damage

EVERYTHING = (
    '<swModel><tasks name="T" priority="5" osekTaskGroup="2" stimuli="P?type=Periodic">'
    + CALLS.format("InterProcessActivation", ' stimulus="I?type=InterProcess"/>')
    + '</tasks><isrs name="J" priority="0"/><runnables name="R" activation="A?type=PeriodicActivation"/>'
    '<activations t="PeriodicActivation" name="A"><deadline value="3" unit="ms"/></activations></swModel>'
    '<hwModel><memoryTypes name="M" xAccessPattern="x"/><system name="S"><quartzes name="q"><quartzes name="r"/></quartzes></system>'
    "</hwModel>"
    + SYSTEM.format(
        '<taskSchedulers name="S"><schedulingAlgorithm t="UserSpecificSchedulingAlgorithm"><parameter key="a" value="1"/>'
        '</schedulingAlgorithm><schedulingUnit t="SchedulingSWUnit" priority="1"><instructions t="X" value="1"/>'
        '</schedulingUnit></taskSchedulers><taskSchedulers name="H"><schedulingUnit t="SchedulingHWUnit">'
        '<delay value="1" unit="ns"/></schedulingUnit></taskSchedulers>'
    )
    + '<stimuliModel><stimuli t="Periodic" name="P"><setModeValueList><entries/></setModeValueList></stimuli>'
    '<stimuli t="InterProcess" name="I"/></stimuliModel><constraintsModel>'
    + OUTER.format("segments", "SubEventChain")
    + '<timingConstraints t="EventChainLatencyConstraint" name="l" scope="inner?type=EventChain outer?type=EventChain"/>'
    '</constraintsModel><mappingModel><taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler" priority="3"/>'
    '<isrAllocation isr="J?type=ISR"/><coreAllocation scheduler="S?type=TaskScheduler" core="C?type=Core"/></mappingModel>'
)


@pytest.mark.parametrize("version", ["0.8.1", "0.8.2"])
def test_a_file_whose_namespace_was_raised_early_takes_the_step(tmp_path, version):
    check_early(tmp_path, "0.8.0", version, "0.8.2", EVERYTHING)


def test_the_step_leaves_alone_what_is_converted(tmp_path):
    check_twice(tmp_path, "0.8.0", "0.8.1", EVERYTHING)


def test_damaged_files_are_migrated(files):
    values = ["", "0", "x", "T?type=Task", "inner?type=EventChain", "gone?type=Periodic gone?type=Core"]
    for text in damaged(EVERYTHING, values, seed=8):
        migrated(files("0.8.0", text), "0.8.3")
