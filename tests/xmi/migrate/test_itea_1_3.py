"""ITEA 1.2.0 -> ITEA 1.3.0."""

import pytest
from itea import all_of, messages, model, nested, only, write
from migration import migrated

TARGET = "ITEA 1.3.0"


def step(folder, **files):
    return migrated(write(folder, "1.2.0", **files), TARGET)


#: What is written: the object, and the attributes that are added.
DEFAULTS = [
    ("hwModel/system/quartzes", {"type": "DYNAMIC"}),
    ("hwModel/memoryTypes", {"type": "RAM"}),
    ("propertyConstraintsModel/memTypeDefinitions", {"type": "RAM"}),
    ("hwModel/networkTypes", {"schedPolicy": "RROBIN"}),
    ("hwModel/networkTypes hw:Bus", {"busType": "CAN", "schedPolicy": "RROBIN"}),
    ("hwModel/system/ports hw:ComplexPort", {"direction": "R"}),
    ("hwModel/system/ports", {}),
    ("hwModel/system/ports/pins hw:ComplexPin", {"direction": "R", "type": "ANALOG"}),
    ("hwModel/system/features hw:FeatureTypes", {"value": "floatingPointUnit"}),
    ("mappingModel", {"addressMappingType": "none"}),
    ("constraintsModel/runnableSequencingConstraints", {"orderType": "successor"}),
    ("constraintsModel/runnableSequencingConstraints/runnableGroups", {"groupingType": "allOfThem"}),
    ("swModel/processPrototypes", {"preemption": "cooperative"}),
    ("swModel/processPrototypes/accessPrecedenceSpec", {"orderType": "ignoreWR"}),
    ("swModel/processPrototypes/orderPrecedenceSpec", {"orderType": "order"}),
    ("swModel/runnables/runnableItems sw:SemaphoreAccess", {"accessEnum": "request"}),
    ("swModel/isrs/callGraph/graphEntries sw:CallSequence/calls sw:WaitEvent", {"maskType": "AND"}),
    (
        "propertyConstraintsModel/allocationConstraints/hwConstraint propertyconstraints:HwCoreProperty",
        {"comparator": "equal"},
    ),
    (
        "propertyConstraintsModel/mappingConstraints/hwConstraint propertyconstraints:HwMemoryConjunction",
        {"conjunction": "and"},
    ),
]


@pytest.mark.parametrize(("path", "written"), DEFAULTS)
def test_what_was_the_default_is_written(tmp_path, path, written):
    models, notes = step(tmp_path, m__amxmi=nested(path))
    [node] = all_of(models, path.rpartition("/")[2].partition(" ")[0])
    assert node.attributes == written
    about = {note.attribute for note in notes if note.kind == "defaulted" and note.origin == node.origin}
    assert about == set(written)


@pytest.mark.parametrize(
    "path",
    [
        "stimuliModel/stimuli stimuli:Periodic/offset",
        "stimuliModel/stimuli stimuli:Single/activation",
        "swModel/runnables/deadline",
        "swModel/activations sw:SingleActivation/max",
        "stimuliModel/clocks stimuli:ClockSinusFunction/shift",
        "stimuliModel/clocks stimuli:ClockMultiplierList/entries/time",
        "constraintsModel/timingConstraints constraints:DelayConstraint/upper",
        "constraintsModel/dataAgeConstraints/dataAge constraints:DataAgeTime/minimumTime",
    ],
)
def test_times_without_unit_are_picoseconds(tmp_path, path):
    models, _ = step(tmp_path, m__amxmi=nested(path))
    assert all_of(models, path.rpartition("/")[2])[0].get("unit") == "ps"


@pytest.mark.parametrize(
    ("root", "tag", "written"),
    [
        ("hw:ComplexPin", "ComplexPin", {"direction": "R", "type": "ANALOG"}),
        ("hw:Bus", "networkTypes", {"busType": "CAN", "schedPolicy": "RROBIN"}),
        ("hw:MemType", "memoryTypes", {"type": "RAM"}),
        ("mapping:MappingModel", "MappingModel", {"addressMappingType": "none"}),
        ("sw:Task", "tasks", {"preemption": "cooperative"}),
    ],
)
def test_files_of_a_single_object(tmp_path, root, tag, written):
    models, _ = step(tmp_path, x__amxmi_hw=model("1.2.0", "", root))
    assert all_of(models, tag)[0].attributes == written


def test_a_task_that_is_a_file_is_converted_like_others(tmp_path):
    content = '<deadline value="3"/><callGraph><graphEntries xsi:type="sw:LabelSwitch"><entries value="1"/></graphEntries></callGraph>'
    models, _ = step(tmp_path, t__amxmi_sw=model("1.2.0", content, "sw:Task", 'name="T"'))
    task = only(models, "swModel", "tasks")
    assert [part.tag for part in task.children] == ["callGraph"]
    assert only(models, "constraintsModel", "requirements").target("process") is task
    assert only(models, "swModel", "modes", "literals").name == "1"


def test_a_stimulus_that_is_a_file_gets_its_units(tmp_path):
    models, _ = step(tmp_path, s__amxmi_stimuli=model("1.2.0", '<recurrence value="3"/>', "stimuli:Periodic"))
    assert only(models, "stimuliModel", "stimuli", "recurrence").get("unit") == "ps"


# Modes

SWITCH = """<callGraph><graphEntries xsi:type="sw:LabelSwitch" label="_l"><entries value="2"/><entries/><entries value="2"/>
    </graphEntries></callGraph>"""


@pytest.mark.parametrize("process", ["tasks", "isrs"])
def test_a_label_switch_is_a_mode_switch(tmp_path, process):
    content = f'<swModel><{process} name="P">{SWITCH}</{process}><labels xmi:id="_l" name="L 1"/></swModel>'
    models, notes = step(tmp_path, m__amxmi=content)
    [switch], [mode_label], [mode] = all_of(models, "graphEntries"), all_of(models, "modeLabels"), all_of(models, "modes")
    assert switch.type == "sw:ModeSwitch"
    assert switch.target("valueProvider") is mode_label
    assert mode_label.name == "L 1"
    assert mode.name == "mode_sw_0_migration_generated"
    assert [literal.name for literal in mode.children] == ["2", "0"]
    assert [entry.target("value").name for entry in switch.children] == ["2", "0", "2"]
    assert [label.name for label in all_of(models, "labels")] == ["L 1"]
    assert "lost" not in {note.kind for note in notes}


def test_switches_in_several_files_share_the_mode_label_of_a_label(tmp_path):
    other = """<swModel><tasks name="P"><callGraph><graphEntries xsi:type="sw:LabelSwitch"><label href="a.amxmi#_l"/>
        <entries value="9"/></graphEntries></callGraph></tasks></swModel>"""
    own = f'<swModel><tasks name="O">{SWITCH}</tasks><labels xmi:id="_l" name="L"/></swModel>'
    models, _ = step(tmp_path, a__amxmi=own, b__amxmi=other)
    assert len(all_of(models, "modeLabels")) == 1
    assert [mode.name for mode in all_of(models, "modes")] == [f"mode_sw_{n}_migration_generated" for n in (0, 1)]


def test_a_label_in_a_missing_file(tmp_path):
    content = """<swModel><tasks><callGraph><graphEntries xsi:type="sw:LabelSwitch"><label href="gone.amxmi#_l"/></graphEntries>
        </callGraph></tasks></swModel>"""
    models, notes = step(tmp_path, m__amxmi=content)
    assert all_of(models, "graphEntries")[0].target("valueProvider").is_proxy
    assert messages(notes, "lost") == ["mode label of a label that is not in the files"]


STIMULUS = """<stimuli xsi:type="stimuli:Single" name="s"><setLabelsList><entries {0} value="3"/></setLabelsList>
    <enablingLabelsList><entries {0}/></enablingLabelsList><disablingLabelsList><entries {0} value="3"/></disablingLabelsList>
    </stimuli>"""


def test_a_switch_uses_the_mode_label_that_a_stimulus_needs(tmp_path):
    stimulus = STIMULUS.format('valueProvider="_l"')
    content = f"""<swModel><tasks>{SWITCH}</tasks><labels xmi:id="_l" name="L"/></swModel>
        <stimuliModel>{stimulus}</stimuliModel>"""
    models, _ = step(tmp_path, m__amxmi=content)
    [mode_label] = all_of(models, "modeLabels")
    assert all_of(models, "graphEntries")[0].target("valueProvider") is mode_label


def split_stimuli(folder):
    stimulus = STIMULUS.format("").replace("<entries ", '<entries><valueProvider href="sw.amxmi-sw#_l"/></entries><entries ', 1)
    return step(
        folder,
        sw__amxmi_sw=model("1.2.0", '<labels xmi:id="_l" name="L"/>', "sw:SWModel"),
        st__amxmi_stimuli=model("1.2.0", stimulus, "stimuli:StimuliModel"),
    )


def test_a_stimuli_file_puts_its_mode_where_the_labels_are(tmp_path):
    models, _ = split_stimuli(tmp_path)
    [mode] = all_of(models, "modes")
    assert mode.parent.tag == "SWModel"
    assert all(entry.target("value").parent is mode for entry in all_of(models, "entries"))


def test_a_stimuli_file_alone_becomes_a_model_that_can_hold_the_mode(tmp_path):
    text = model("1.2.0", STIMULUS.format(""), "stimuli:StimuliModel")
    models, _ = step(tmp_path, st__amxmi_stimuli=text)
    root = models.trees[0].root
    assert (root.tag, sorted(child.tag for child in root.children)) == ("AMALTHEA", ["stimuliModel", "swModel"])
    assert only(models, "swModel", "modes").child("literals").name == "3"


# Deadlines

PROCESSES = """<isrs name="I"><deadline value="1" unit="us"/></isrs><processPrototypes name="P p"><deadline value="2"/>
    </processPrototypes><tasks><!-- why --><deadline value="3" unit="ms"/></tasks>"""


def test_deadlines_are_requirements_in_the_constraints_that_are_there(tmp_path):
    content = f'<constraintsModel><requirements name="old"/></constraintsModel><swModel>{PROCESSES}</swModel>'
    models, notes = step(tmp_path, m__amxmi=content)
    requirements = only(models, "constraintsModel").all("requirements")
    assert [requirement.name for requirement in requirements] == ["old", "I", "P p", ""]
    values = [limit.attributes for limit in all_of(models, "limitValue")]
    assert values == [{"value": "1", "unit": "us"}, {"value": "2", "unit": "ps"}, {"value": "3", "unit": "ms"}]
    assert requirements[3].comments == ["<!-- why -->"]
    assert all_of(models, "deadline") == []
    assert len(messages(notes, "converted")) == 3


def test_deadlines_in_a_file_of_the_software_model(tmp_path):
    text = model("1.2.0", PROCESSES, "sw:SWModel")
    models, _ = step(tmp_path, sw__amxmi_sw=text)
    assert len(only(models, "constraintsModel").children) == 3
    assert len(only(models, "swModel").children) == 3


def test_the_initial_value_of_a_label_is_reported(tmp_path):
    _, notes = step(tmp_path, m__amxmi='<swModel><labels name="L" initialValue="7"/></swModel>')
    assert [(note.kind, note.detail, note.attribute) for note in notes] == [("lost", "L: 7", "initialValue")]
