"""Two models compared by meaning."""

from random import Random

import pytest
from strategies import random_model
from support import DATA

import amalthea_uros as amuros
from amalthea_uros import (
    ActivityGraph,
    Amalthea,
    CustomProperty,
    Group,
    Label,
    LabelAccess,
    Model,
    PeriodicStimulus,
    Preemption,
    Runnable,
    RunnableCall,
    StimuliModel,
    StringObject,
    SWModel,
    Task,
    Time,
)
from amalthea_uros.metamodel.difference import difference


def application():
    labels = [Label(name=f"L{i}") for i in range(3)]
    runnables = [
        Runnable(name=f"R{i}", activity_graph=ActivityGraph(items=[LabelAccess(data=label) for label in labels]))
        for i in range(3)
    ]
    stimulus = PeriodicStimulus(name="S", recurrence=Time(10, "ms"))
    calls = [RunnableCall(runnable=runnable) for runnable in runnables * 40]
    task = Task(name="T", stimuli=[stimulus], activity_graph=ActivityGraph(items=calls))
    task.custom_properties.append(CustomProperty(key="k", value=StringObject(value="v")))
    software = SWModel(tasks=[task], runnables=runnables, labels=labels)
    return Model.of(Amalthea(sw_model=software, stimuli_model=StimuliModel(stimuli=[stimulus])))


@pytest.fixture
def old():
    return application()


@pytest.fixture
def new():
    return application()


def told(old, new):
    return [(c.kind.value, c.object_class, c.object_name, c.feature, c.old, c.new) for c in difference(old, new)]


def test_equal_models(old, new):
    assert told(old, new) == []


def test_a_value(old, new):
    new[Task, "T"].preemption = Preemption.COOPERATIVE
    assert told(old, new) == [("changed", "Task", "T", "preemption", "_undefined_", "cooperative")]
    assert told(new, old) == [("changed", "Task", "T", "preemption", "cooperative", "_undefined_")]


def test_a_default_that_is_written_out_means_nothing(old, new):
    new[Label, "L0"].constant = False
    assert told(old, new) == []


def test_a_quantity(old, new):
    new[PeriodicStimulus, "S"].recurrence = Time(20, "ms")
    assert told(old, new) == [("changed", "PeriodicStimulus", "S", "recurrence", "10 ms", "20 ms")]


def test_a_reference(old, new):
    next(new.all(RunnableCall)).runnable = new[Runnable, "R2"]
    assert told(old, new) == [("changed", "RunnableCall", "T.activityGraph.items[0]", "runnable", "R0", "R2")]


def test_one_part_more_in_the_middle(old, new):
    new[Task, "T"].activity_graph.items.insert(60, Group(items=[RunnableCall()]))
    assert told(old, new) == [("added", "Group", "T.activityGraph.items[60]", "", "", "with 1 part")]
    assert told(new, old) == [("removed", "Group", "T.activityGraph.items[60]", "", "with 1 part", "")]


def test_another_order_of_what_is_executed(old, new):
    new[Task, "T"].activity_graph.items.reverse()
    ((kind, cls, name, feature, _, text),) = told(old, new)
    assert (kind, cls, name, feature) == ("changed", "ActivityGraph", "T.activityGraph", "items")
    assert text.endswith("of 120 in another order")


def test_another_order_of_named_objects_means_nothing(old, new):
    new.root.sw_model.runnables.reverse()
    new.root.sw_model.labels.reverse()
    assert told(old, new) == []


def test_an_object_more_and_less(old, new):
    new.root.sw_model.labels.append(Label(name="L9"))
    del old.root.sw_model.labels[:]
    for access in [*old.all(LabelAccess), *new.all(LabelAccess)]:
        access.data = None
    assert {(kind, name) for kind, _, name, *_ in told(old, new)} == {("added", name) for name in ("L0", "L1", "L2", "L9")}


def test_a_rename_is_one_change(old, new):
    new[Label, "L1"].name = "Speed"
    old[Label, "L1"].b_volatile = new[Label, "Speed"].b_volatile = True
    assert told(old, new) == [("changed", "Label", "Speed", "name", "L1", "Speed")]


def test_an_entry_of_a_map_is_found_by_its_key(old, new):
    properties = new[Task, "T"].custom_properties
    properties.insert(0, CustomProperty(key="a", value=StringObject(value="w")))
    properties[1].value.value = "x"
    assert told(old, new) == [
        ("added", "CustomProperty", "T.customProperties[0]", "", "", "with 1 part"),
        ("changed", "StringObject", "T.customProperties[1].value", "value", "v", "x"),
    ]


def test_the_division_into_files_means_nothing(old, new):
    stimuli, new.root.stimuli_model = new.root.stimuli_model, None
    split = Model([amuros.Document(new.root), amuros.Document(Amalthea(stimuli_model=stimuli))])
    assert told(old, split) == []


def test_the_version(old):
    newer = application()
    newer.documents[0].version = "3.2.0"
    assert told(old, newer) == [("changed", "Amalthea", "Amalthea", "version", "3.3.0", "3.2.0")]


def test_unknown_content(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text((DATA / "brake.amxmi").read_text().replace('name="Act"', 'name="Act" vendor="7"'))
    assert told(amuros.load(DATA / "brake.amxmi"), amuros.load(path)) == [
        ("changed", "Runnable", "Act", "unknown content", "", 'vendor="7"')
    ]


@pytest.mark.parametrize("seed", range(30))
def test_a_model_saved_and_loaded_is_the_same(seed, tmp_path):
    model = random_model(Random(seed), "3.3.0")
    amuros.save(model, tmp_path / "m.amxmi")
    assert told(model, amuros.load(tmp_path / "m.amxmi")) == []
