"""0.8.0 -> 0.8.1, as far as the pairs of models do not show it."""

from functools import partial

import pytest
from inline_models import check_early, check_step, check_twice, damaged, of_kind, text_property, written
from migration import migrated

from amalthea_uros.xmi.migrate.notes import NoteKind


@pytest.fixture
def files(tmp_path):
    """Write files of a version."""
    return partial(written, tmp_path)


@pytest.fixture
def same(tmp_path):
    """Assert what some files become."""
    return partial(check_step, tmp_path, "0.8.0", "0.8.1")


# Priorities

TWO_TASKS = '<swModel><tasks name="A" {}/><tasks name="B" {}/></swModel><mappingModel>{}</mappingModel>'


def test_a_default_of_the_allocation_does_not_hide_the_priority_of_its_task(same):
    notes = same(
        TWO_TASKS.format('priority="5"', 'priority="1"', '<taskAllocation task="A?type=Task" priority="0"/>'),
        f'<swModel><tasks name="A">{text_property("priority", 5)}</tasks><tasks name="B">{text_property("priority", 1)}</tasks>'
        '</swModel><mappingModel><taskAllocation task="A?type=Task"/></mappingModel>',
    )
    assert ("priority 0, the old default, left out: the priority of the task applies", "5") in of_kind(
        notes, NoteKind.CONVERTED
    )
    assert not of_kind(notes, NoteKind.LOST)


def test_priority_0_of_a_task_is_kept_where_no_allocation_states_one(same):
    notes = same(
        TWO_TASKS.format('priority="0"', 'priority="0"', '<taskAllocation task="B?type=Task" priority="3"/>'),
        f'<swModel><tasks name="A">{text_property("priority", 0)}</tasks><tasks name="B"/></swModel>'
        '<mappingModel><taskAllocation task="B?type=Task"><schedulingParameters priority="3"/></taskAllocation></mappingModel>',
    )
    assert not of_kind(notes, NoteKind.LOST)


def test_priority_0_of_a_task_is_kept_for_the_allocation_that_states_none(same):
    allocations = '<taskAllocation task="A?type=Task"/><taskAllocation task="A?type=Task"{}</mappingModel>'
    same(
        '<swModel><tasks name="A" priority="0"/></swModel><mappingModel>' + allocations.format(' priority="3"/>'),
        f'<swModel><tasks name="A">{text_property("priority", 0)}</tasks></swModel><mappingModel>'
        + allocations.format('><schedulingParameters priority="3"/></taskAllocation>'),
    )


def test_priority_0_of_an_isr_is_kept_for_the_allocation_that_states_none(same):
    mapping = '<mappingModel><isrAllocation isr="I?type=ISR"/><isrAllocation isr="I?type=ISR" priority="3"/></mappingModel>'
    same(
        f'<swModel><isrs name="I" priority="0"/></swModel>{mapping}',
        f'<swModel><isrs name="I">{text_property("priority", 0)}</isrs></swModel>{mapping}',
    )


def test_priority_0_of_an_allocation_stays_where_the_isr_states_none(same):
    model = '<swModel><isrs name="I"/></swModel><mappingModel><isrAllocation isr="I?type=ISR" priority="0"/>'
    model += '<isrAllocation priority="0"/></mappingModel>'
    same(model, model)


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


def test_the_task_may_be_in_another_file(same):
    same(
        [
            '<swModel><tasks name="A B" priority="5"/></swModel>',
            '<mappingModel><taskAllocation priority="0"><task href="amlt:/#A+B?type=Task"/></taskAllocation></mappingModel>',
        ],
        [
            f'<swModel><tasks name="A B">{text_property("priority", 5)}</tasks></swModel>',
            '<mappingModel><taskAllocation><task href="amlt:/#A+B?type=Task"/></taskAllocation></mappingModel>',
        ],
    )


def test_the_task_may_be_in_a_file_of_a_later_version(files):
    newer = files("0.8.1", f'<swModel><tasks name="A">{text_property("priority", 5)}</tasks></swModel>')
    older = files(
        "0.8.0", '<mappingModel><taskAllocation priority="0"><task href="amlt:/#A?type=Task"/></taskAllocation></mappingModel>'
    )
    models, _ = migrated([*newer, *older], "0.8.1")
    (allocation,) = models.trees[1].root.find("mappingModel", "taskAllocation")
    assert not allocation.children


def test_existing_scheduling_parameters_are_used(same):
    same(
        '<mappingModel><taskAllocation priority="4"><schedulingParameters><minBudget value="1" unit="ms"/></schedulingParameters>'
        "</taskAllocation></mappingModel>",
        '<mappingModel><taskAllocation><schedulingParameters priority="4"><minBudget value="1" unit="ms"/></schedulingParameters>'
        "</taskAllocation></mappingModel>",
    )


def test_a_default_of_the_allocation_does_not_hide_the_priority_of_its_isr(same):
    before = "".join(f'<isrs name="{name}" priority="{number}"/>' for name, number in (("I", 9), ("J", 0), ("K", 7), ("L", 6)))
    after = f'<isrs name="I">{text_property("priority", 9)}</isrs><isrs name="J"/>'
    after += f'<isrs name="K">{text_property("priority", 7)}</isrs><isrs name="L">{text_property("priority", 6)}</isrs>'
    allocations = (
        '</swModel><mappingModel><isrAllocation isr="I?type=ISR" priority="{}"/><isrAllocation isr="J?type=ISR" priority="0"/>'
    )
    allocations += '<isrAllocation isr="K?type=ISR" priority="8"/><isrAllocation isr="L?type=ISR"/></mappingModel>'
    before = f"<swModel>{before}{allocations.format(0)}"
    same(before, f"<swModel>{after}{allocations.format(9)}")


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


def test_every_class_of_stimuli_is_renamed_also_in_references_to_no_file(same):
    names = ("ArrivalCurve", "InterProcess", "Periodic", "Single", "Sporadic", "Synthetic")
    before = "".join(f'<stimuli t="{name}" name="{name}"/>' for name in (*names, "PeriodicEvent"))
    after = "".join(f'<stimuli t="{name}Stimulus" name="{name}"/>' for name in names)
    after += '<stimuli t="VariableRateStimulus" name="PeriodicEvent"/>'
    task = '<swModel><tasks name="T"><stimuli href="amlt:/#elsewhere?type={}"/></tasks></swModel>'
    same(
        f"<stimuliModel>{before}</stimuliModel>{task.format('PeriodicEvent')}",
        f"<stimuliModel>{after}</stimuliModel>{task.format('VariableRateStimulus')}",
    )


def test_mode_value_lists(same):
    entry = '<entries{} valueProvider="L?type=ModeLabel" value="M/a?type=ModeLiteral"/>'
    model = '<swModel><modes name="M"><literals name="a"/></modes><modeLabels name="L"/></swModel><stimuliModel>'
    model += '<stimuli t="CustomStimulus" name="S">{}</stimuli></stimuliModel>'
    lists = ("setModeValueList", "enablingModeValueList", "disablingModeValueList")

    def stimulus(typed):
        return model.format("".join(f"<{name}>{entry.format(typed)}</{name}>" for name in lists))

    same(stimulus(""), stimulus(' t="ModeValue"'))
    conjunction = model.format(
        '<enablingModeValueList><entries t="ModeValueConjunction"><entries/></entries></enablingModeValueList>'
    )
    same(conjunction, conjunction)


# Software

ACTIVATION = '<swModel><runnables name="R" {}="P?type=PeriodicActivation"/><activations t="PeriodicActivation" name="P">'


def test_activations(same):
    same(
        ACTIVATION.format("activation") + '<deadline value="3" unit="ms"/></activations>'
        '<activations t="EventActivation" name="E" trigger="e?type=ProcessEvent"/></swModel>'
        '<eventModel><events t="ProcessEvent" name="e"/></eventModel>',
        ACTIVATION.format("activations")
        + '<customProperties key="deadline"><value t="TimeObject" value="3" unit="ms"/></customProperties></activations>'
        '<activations t="EventActivation" name="E" triggeringEvents="e?type=ProcessEvent"/></swModel>'
        '<eventModel><events t="ProcessEvent" name="e"/></eventModel>',
    )


def test_the_keys_of_custom_properties_stay_unique(same):
    model = f'<swModel><activations t="PeriodicActivation" name="P">{text_property("deadline", "x")}{{}}</activations>'
    model += "</swModel>"
    same(
        model.format('<deadline value="3" unit="ms"/>'),
        model.format('<customProperties key="deadline 2"><value t="TimeObject" value="3" unit="ms"/></customProperties>'),
    )


def test_the_activation_of_a_process_prototype_keeps_its_name(same):
    model = '<swModel><processPrototypes name="P" activation="A?type=SingleActivation"/>'
    model += '<activations t="SingleActivation" name="A"/></swModel>'
    same(model, model)


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


def test_a_custom_property_without_value_of_a_scheduling_unit_moves_like_others(same):
    key = "SchedulingHWUnit_CustomProperty__k"
    same(
        SYSTEM.format(
            '<taskSchedulers name="S"><schedulingUnit t="SchedulingHWUnit"><customProperties key="k"/></schedulingUnit>'
            "</taskSchedulers>"
        ),
        SYSTEM.format(f'<taskSchedulers name="S"><customProperties key="{key}"/></taskSchedulers>'),
    )


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


def test_what_else_a_scheduling_unit_states_is_not_lost_silently(same):
    unit = '<schedulingUnit t="SchedulingHWUnit" priority="0" x="1"><y z="2"/></schedulingUnit>'
    notes = same(
        SYSTEM.format(f'<taskSchedulers name="S">{unit}</taskSchedulers>'), SYSTEM.format('<taskSchedulers name="S"/>')
    )
    assert of_kind(notes, NoteKind.LOST) == [("other content of a scheduling unit", "x=1, y (z=2)")]


def test_parameters_of_a_scheduler_in_its_algorithm(same):
    model = SYSTEM.format(
        '<taskSchedulers name="S"><schedulingAlgorithm t="UserSpecificSchedulingAlgorithm"><{0} key="a" value="1"/>'
        '<{0} key="b" value="2"/></schedulingAlgorithm></taskSchedulers>'
        '<taskSchedulers name="P"><schedulingAlgorithm t="PfairPD2" quantSizeNs="1000"/></taskSchedulers>'
    )
    same(model.format("parameter"), model.format("parameterExtensions"))


# Mapping and hardware


def test_allocations_of_cores_in_another_file(same):
    hardware = (
        '<hwModel><system name="S"><ecus name="E"><microcontrollers name="M"><cores name="C 0"/></microcontrollers></ecus>'
    )
    hardware += "</system></hwModel>"
    mapping = '<mappingModel><{0}><{1} href="amlt:/#C+0?type=Core"/></{0}></mappingModel>'
    same(
        [hardware, mapping.format("coreAllocation", "core")],
        [hardware, mapping.format("schedulerAllocation", "responsibility")],
    )


def test_quartzes_are_collected_in_order_and_lose_their_parts(same):
    notes = same(
        '<hwModel><memoryTypes name="T" xAccessPattern="3-1-1"/><system name="S">'
        '<memories name="m"><prescaler quartz="q2?type=Quartz"/><quartzes name="q1"><frequency value="1"/>'
        '<quartzes name="q2"/><memories name="gone"><quartzes name="q3"/></memories><ports name="p"/></quartzes></memories>'
        '<quartzes name="q4"/></system></hwModel>',
        '<hwModel><memoryTypes name="T"/><system name="S"><memories name="m"><prescaler quartz="q2?type=Quartz"/></memories>'
        '<quartzes name="q1"><frequency value="1"/></quartzes><quartzes name="q2"/><quartzes name="q3"/><quartzes name="q4"/>'
        "</system></hwModel>",
    )
    assert of_kind(notes, NoteKind.LOST) == [
        ("access pattern of a memory type", "3-1-1"),
        ("memories of a quartz", "gone"),
        ("ports of a quartz", "p"),
    ]
    assert of_kind(notes, NoteKind.MOVED) == [("quartz -> system", name) for name in ("q1", "q2", "q3")]


def test_a_model_without_system_has_no_quartzes(same):
    same('<hwModel><coreTypes name="C"/></hwModel>', '<hwModel><coreTypes name="C"/></hwModel>')


# Event chains

OUTER = '<eventChains name="outer"><{0} t="{1}"><eventChain name="inner"/></{0}></eventChains>'


@pytest.mark.parametrize("tag", ["segments", "strands"])
def test_inner_chains_of_another_file(same, tag):
    inner = '<scope href="amlt:/#inner?type=EventChain"/>'
    scope = '<timingConstraints t="EventChainSynchronizationConstraint" name="c">{}</timingConstraints>'
    outer = '<scope href="amlt:/#outer?type=EventChain"/>'
    kept = '<customProperties key="scope"><value t="ListObject"><values t="StringObject" '
    kept += 'value="amlt:/#inner?type=EventChain"/></value></customProperties>'
    same(
        [
            f"<constraintsModel>{OUTER.format(tag, 'SubEventChain')}</constraintsModel>",
            f"<constraintsModel>{scope.format(outer + inner)}</constraintsModel>",
        ],
        [
            f"<constraintsModel>{OUTER.format(tag, 'EventChainContainer')}</constraintsModel>",
            f"<constraintsModel>{scope.format(outer + kept)}</constraintsModel>",
        ],
    )


def test_a_chain_in_no_file_may_be_an_outer_one(same):
    model = '<constraintsModel><eventChains name="a"><segments t="EventChainReference">{}</segments></eventChains>'
    model += "</constraintsModel>"
    reference = '<eventChain href="amlt:/#b?type=EventChain"/>'
    same(model.format(reference), model.format(reference))


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
