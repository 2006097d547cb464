"""What counts as a difference of two models, and how it is told."""

import itertools
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support import model_text

from amalthea_uros.difference.comparison import ChangeKind, ModelChange, difference
from amalthea_uros.difference.parts import align, increasing
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save


def system() -> Model:
    """A small model with a bit of everything; each call gives new objects."""
    labels = [am.Label(name=f"L{i}", size=am.DataSize(8 * (i + 1), "bit")) for i in range(4)]
    runnables = [runnable(i, labels) for i in range(4)]
    stimuli = [am.PeriodicStimulus(name=f"every_{n}ms", recurrence=am.Time(n, "ms")) for n in (5, 10, 20)]
    tasks = [
        am.Task(
            name=f"T{i}",
            preemption=am.Preemption.PREEMPTIVE,
            stimuli=[stimuli[i], stimuli[i + 1]],
            activity_graph=am.ActivityGraph(items=[am.RunnableCall(runnable=r) for r in (*runnables, runnables[i])]),
            custom_properties=[am.CustomProperty(key=key, value=am.StringObject(value=f"{key}{i}")) for key in "ab"],
        )
        for i in range(2)
    ]
    scheduler = am.TaskScheduler(name="S")
    return Model.of(
        am.Amalthea(
            sw_model=am.SWModel(tasks=tasks, runnables=runnables, labels=labels),
            stimuli_model=am.StimuliModel(stimuli=stimuli),
            os_model=am.OSModel(
                operating_systems=[am.OperatingSystem(name="OS", task_schedulers=[scheduler]), am.OperatingSystem(name="OS2")]
            ),
            mapping_model=am.MappingModel(task_allocation=[am.TaskAllocation(task=t, scheduler=scheduler) for t in tasks]),
        )
    )


def runnable(number: int, labels: list[am.Label]) -> am.Runnable:
    return am.Runnable(
        name=f"R{number}",
        activity_graph=am.ActivityGraph(
            items=[
                am.LabelAccess(data=labels[number], access=am.LabelAccessEnum.READ),
                am.Ticks(default=am.DiscreteValueConstant(value=100 * number)),
            ]
        ),
    )


def task(model: Model, name: str = "T0") -> am.Task:
    return model[am.Task, name]


def calls(*runnables: am.Runnable) -> am.ActivityGraph:
    return am.ActivityGraph(items=[am.RunnableCall(runnable=r) for r in runnables])


def told(changes: list[ModelChange]) -> list[tuple[str, str, str, str, str, str]]:
    return [(c.kind.value, c.class_name, c.qualified_name, c.feature, c.old, c.new) for c in changes]


def read(folder: Path, body: str, version: str = "3.3.0", name: str = "m.amxmi") -> Model:
    folder.mkdir(exist_ok=True)
    path = folder / name
    path.write_text(model_text(body, version))
    return load(path)


def compared(tmp_path: Path, old: str, new: str, versions: tuple[str, str] = ("3.3.0", "3.3.0")):
    return told(difference(read(tmp_path / "old", old, versions[0]), read(tmp_path / "new", new, versions[1])))


# What is told


def _reverse_side_by_side(model: Model) -> None:
    """Reverse objects whose order means nothing."""
    for collection in (model.root.sw_model.tasks, model.root.sw_model.labels, model.root.stimuli_model.stimuli):
        collection[:] = list(reversed(collection))
    task(model).custom_properties.append(task(model).custom_properties.pop(0))
    model.root.mapping_model.task_allocation.append(model.root.mapping_model.task_allocation.pop(0))


def _rename_and_refer(model: Model) -> None:
    model[am.Runnable, "R1"].name = "Renamed"
    model[am.Label, "L2"].name = "Renamed"


def _change_quantities(model: Model) -> None:
    model[am.PeriodicStimulus, "every_5ms"].recurrence = am.Time(6, "ms")
    model[am.Label, "L0"].size = None


def _change_properties(model: Model) -> None:
    task(model).custom_properties.insert(0, am.CustomProperty(key="0", value=am.StringObject(value="x")))
    task(model).custom_properties[2].value = am.StringObject(value="changed")


def _change_allocations(model: Model) -> None:
    model.root.mapping_model.task_allocation.reverse()
    model.root.mapping_model.task_allocation[0].scheduler = None


def _add_runnable(model: Model) -> None:
    added = am.Runnable(name="New", activity_graph=calls(model[am.Runnable, "R0"]), parameters=[am.RunnableParameter(name="p")])
    model.root.sw_model.runnables.append(added)


def _call_earlier(model: Model) -> None:
    items = task(model).activity_graph.items
    items.insert(0, items.pop(3))


#: What is done to a model -> the changes that are reported: kind, class, name, feature, old, new.
TOLD = {
    "an attribute": (
        lambda model: setattr(task(model), "preemption", am.Preemption.COOPERATIVE),
        [("changed", "Task", "T0", "preemption", "preemptive", "cooperative")],
    ),
    "an attribute that was not set": (
        lambda model: setattr(task(model), "preemption", None),
        [("changed", "Task", "T0", "preemption", "preemptive", "unset")],
    ),
    "quantities, as values of their holders": (
        _change_quantities,
        [
            ("changed", "Label", "L0", "size", "8 bit", "unset"),
            ("changed", "PeriodicStimulus", "every_5ms", "recurrence", "5 ms", "6 ms"),
        ],
    ),
    "a reference, by name": (
        lambda model: setattr(task(model).activity_graph.items[1], "runnable", model[am.Runnable, "R3"]),
        [("changed", "RunnableCall", "T0.activityGraph.items[1]", "runnable", "R1", "R3")],
    ),
    "what came to and went from references": (
        lambda model: task(model).stimuli.__setitem__(0, model[am.PeriodicStimulus, "every_20ms"]),
        [("changed", "Task", "T0", "stimuli", "removed every_5ms", "added every_20ms")],
    ),
    "an object without its parts": (_add_runnable, [("added", "Runnable", "New", "", "", "")]),
    "a move": (
        lambda model: model[am.OperatingSystem, "OS2"].task_schedulers.append(model[am.TaskScheduler, "S"]),
        [("moved", "TaskScheduler", "S", "taskSchedulers", "OS", "OS2")],
    ),
    "no move of parts when their container is renamed": (
        lambda model: setattr(model[am.OperatingSystem, "OS"], "name", "Other"),
        [("changed", "OperatingSystem", "Amalthea.osModel.operatingSystems[0]", "name", "OS", "Other")],
    ),
    "map entries, matched by key": (
        _change_properties,
        [
            ("added", "CustomProperty", "T0.customProperties[0]", "", "", "0"),
            ("changed", "CustomProperty", "T0.customProperties[2]", "value", "b0", "changed"),
        ],
    ),
    "allocations, matched by what they are about": (
        _change_allocations,
        [("changed", "TaskAllocation", "Amalthea.mappingModel.taskAllocation[0]", "scheduler", "S", "unset")],
    ),
    "the order of calls, as a change of their container": (
        _call_earlier,
        [("changed", "ActivityGraph", "T0.activityGraph", "items", "", "reordered RunnableCall R3")],
    ),
    "no order of objects that stand side by side": (_reverse_side_by_side, []),
    "renames, and references follow": (
        _rename_and_refer,
        [("changed", "Runnable", "Renamed", "name", "R1", "Renamed"), ("changed", "Label", "Renamed", "name", "L2", "Renamed")],
    ),
}


@pytest.mark.parametrize(("edit", "expected"), TOLD.values(), ids=TOLD)
def test_what_is_told(edit, expected) -> None:
    old, new = system(), system()
    edit(new)
    changes = difference(old, new)
    assert told(changes) == expected
    if expected and expected[0][1] == "Task":
        assert (changes[0].old_element, changes[0].new_element) == (task(old), task(new))


def test_reference_list_in_another_order() -> None:
    old, new = system(), system()
    task(new).stimuli.reverse()
    (change,) = difference(old, new)
    assert (change.feature, change.old) == ("stimuli", "")
    assert change.new in ("reordered every_5ms", "reordered every_10ms")


def test_moved_between_objects_with_unique_names() -> None:
    def model(holder: str) -> Model:
        structures = [am.HwStructure(name=name) for name in "AB"]
        structures["AB".index(holder)].structures.append(am.HwStructure(name="inner"))
        return Model.of(am.Amalthea(hw_model=am.HWModel(structures=structures)))

    assert told(difference(model("A"), model("B"))) == [("moved", "HwStructure", "inner", "structures", "A", "B")]


def test_map_entries_are_matched_by_the_object_that_is_their_key() -> None:
    def model(*values: tuple[str, str]) -> Model:
        definitions = {name: am.SchedulingParameterDefinition(name=name) for name in ("priority", "quota")}
        parameters = [am.SchedulingParameter(key=definitions[key], value=am.StringObject(value=value)) for key, value in values]
        scheduler = am.TaskScheduler(name="S", scheduling_parameters=parameters)
        os_model = am.OSModel(
            scheduling_parameter_definitions=definitions.values(),
            operating_systems=[am.OperatingSystem(name="OS", task_schedulers=[scheduler])],
        )
        return Model.of(am.Amalthea(os_model=os_model))

    old, new = model(("priority", "1"), ("quota", "2")), model(("quota", "2"), ("priority", "3"))
    assert told(difference(old, new)) == [("changed", "SchedulingParameter", "S.schedulingParameters[1]", "value", "1", "3")]


def test_named_parts_are_matched_by_name() -> None:
    old, new = system(), system()
    task(old).activity_graph.items = [am.Group(name="a"), am.Group(name="b")]
    task(new).activity_graph.items = [am.Group(name="c", ordered=False), am.Group(name="a"), am.Group(name="b", ordered=False)]
    assert told(difference(old, new)) == [
        ("added", "Group", "T0.activityGraph.items[0]", "", "", "c"),
        ("changed", "Group", "T0.activityGraph.items[2]", "ordered", "true", "false"),
    ]


# Order


def many_calls(count: int) -> Model:
    model = system()
    task(model).activity_graph.items = [am.RunnableCall(runnable=model[am.Runnable, f"R{i % 3}"]) for i in range(count)]
    return model


@pytest.mark.parametrize("place", [0, 99, 100, 101, 200])
def test_call_inserted_among_many_is_one_addition(place: int) -> None:
    old, new = many_calls(200), many_calls(200)
    task(new).activity_graph.items.insert(place, am.RunnableCall(runnable=new[am.Runnable, "R3"]))
    assert told(difference(old, new)) == [("added", "RunnableCall", f"T0.activityGraph.items[{place}]", "", "", "R3")]


# Renames


def test_ambiguous_renames_are_removals_and_additions() -> None:
    old, new = system(), system()
    for model, names in ((old, "ab"), (new, "cd")):
        model.root.sw_model.labels.extend(am.Label(name=name, size=am.DataSize(99, "bit")) for name in names)
    assert Counter(c.kind for c in difference(old, new)) == {ChangeKind.REMOVED: 2, ChangeKind.ADDED: 2}


def test_other_content_is_no_rename() -> None:
    old, new = system(), system()
    new[am.Label, "L1"].name = "Other"
    new[am.Label, "Other"].constant = True
    kinds = {(c.kind.value, c.qualified_name) for c in difference(old, new) if c.class_name == "Label"}
    assert kinds == {("removed", "L1"), ("added", "Other")}


def test_references_to_different_things_are_no_rename() -> None:
    def model(name: str, label: str, bits: int) -> Model:
        target = am.Label(name=label, size=am.DataSize(bits, "bit"))
        access = am.Runnable(name=name, activity_graph=am.ActivityGraph(items=[am.LabelAccess(data=target)]))
        return Model.of(am.Amalthea(sw_model=am.SWModel(runnables=[access], labels=[target])))

    changes = difference(model("R1", "L1", 8), model("R2", "L2", 16))
    assert Counter((c.kind.value, c.class_name) for c in changes) == {
        (kind, cls): 1 for kind in ("added", "removed") for cls in ("Runnable", "Label")
    }


def test_parts_with_the_name_in_front_go_with_a_renamed_container() -> None:
    def model(board: str) -> Model:
        structure = am.HwStructure(name=board, ports=[am.HwPort(name="eth0"), am.HwPort(name="eth1")])
        return Model.of(am.Amalthea(hw_model=am.HWModel(structures=[structure])))

    assert told(difference(model("Board"), model("Card"))) == [("changed", "HwStructure", "Card", "name", "Board", "Card")]


def test_members_go_with_a_renamed_namespace() -> None:
    def model(name: str) -> Model:
        namespace = am.Namespace(name=name)
        labels = [am.Label(name="L", namespace=namespace), am.Label(name="M", namespace=namespace)]
        return Model.of(
            am.Amalthea(common_elements=am.CommonElements(namespaces=[namespace]), sw_model=am.SWModel(labels=labels))
        )

    assert told(difference(model("old"), model("new"))) == [("changed", "Namespace", "new", "name", "old", "new")]


def test_duplicate_names_are_matched_in_order() -> None:
    old, new = system(), system()
    for model, sizes in ((old, (1, 2)), (new, (1, 3))):
        model.root.sw_model.labels.extend(am.Label(name="twice", size=am.DataSize(bits, "bit")) for bits in sizes)
    assert told(difference(old, new)) == [("changed", "Label", "twice", "size", "2 bit", "3 bit")]


# What means nothing


def test_default_means_the_same_as_absence(tmp_path) -> None:
    explicit = '<swModel><labels name="L" constant="false" bVolatile="false"/></swModel>'
    assert compared(tmp_path, explicit, '<swModel><labels name="L"/></swModel>') == []
    assert compared(tmp_path, explicit, '<swModel><labels name="L" constant="true"/></swModel>') == [
        ("changed", "Label", "L", "constant", "false", "true")
    ]


def test_empty_sub_model_means_nothing(tmp_path) -> None:
    assert compared(tmp_path, "<swModel/><componentsModel/>", "") == []


def test_spelling_means_nothing(tmp_path) -> None:
    old = """<swModel>
      <tasks xmi:id="T?type=Task" name="T" stimuli="S?type=PeriodicStimulus"/></swModel>
      <hwModel><definitions t="MemoryDefinition" name="M">
      <accessLatency t="DiscreteValueConstant" value="3"/>
      <size value="8" unit="kB"/></definitions><domains t="FrequencyDomain" name="F">
      <defaultValue value="80000" unit="Hz"/></domains></hwModel>
      <stimuliModel><stimuli t="PeriodicStimulus" name="S"/></stimuliModel>"""
    new = """<stimuliModel><stimuli name="S" t="PeriodicStimulus"/></stimuliModel>
      <hwModel><domains t="FrequencyDomain" name="F"><defaultValue unit="Hz" value="8.0E4"/></domains>
      <definitions name="M" t="MemoryDefinition"><size unit="kB" value="+8"/>
      <accessLatency value="03" t="DiscreteValueConstant"/></definitions></hwModel>
      <!-- T --><swModel><tasks name="T"><stimuli t="PeriodicStimulus" href="amlt:/#S?type=PeriodicStimulus"/>
      </tasks></swModel>"""
    assert compared(tmp_path, old, new) == []


def test_files_mean_nothing(tmp_path) -> None:
    task_text = '<swModel><tasks name="T" stimuli="S?type=PeriodicStimulus"/></swModel>'
    property_text = '<customProperties key="k"><value t="StringObject" value="v"/></customProperties>'
    stimulus = '<stimuliModel><stimuli t="PeriodicStimulus" name="S"/></stimuliModel>'
    label = '<labels name="L"/>'
    one = read(tmp_path / "one", property_text + task_text.replace("</sw", f"{label}</sw") + stimulus)
    folder = tmp_path / "several"
    read(folder, task_text, name="a.amxmi")
    read(folder, property_text + stimulus, name="b.amxmi")
    read(folder, f"<swModel>{label}</swModel>", name="c.amxmi")
    assert difference(one, load(folder)) == []
    assert difference(load(folder), one) == []


def test_missing_target_is_compared_by_its_name(tmp_path) -> None:
    def body(name: str) -> str:
        return f'<swModel><tasks name="T" stimuli="{name}?type=PeriodicStimulus"/></swModel>'

    assert compared(tmp_path, body("A"), body("A")) == []
    assert compared(tmp_path, body("A"), body("B")) == [("changed", "Task", "T", "stimuli", "removed A", "added B")]


# Unknown content, versions


def test_unknown_content_is_compared_as_text(tmp_path) -> None:
    old = '<swModel><labels name="L" colour="red"><future a="1"> <x/></future></labels></swModel>'
    assert compared(tmp_path, old, old.replace("> <x/>", ">\n<x/>")) == []
    assert compared(tmp_path, old, old.replace("red", "blue").replace('a="1"', 'a="2"')) == [
        ("changed", "Label", "L", "colour", "red", "blue"),
        ("changed", "Label", "L", "future", '<future a="1"><x/></future>', '<future a="2"><x/></future>'),
    ]


def test_another_version_is_one_change(tmp_path) -> None:
    body = '<osModel><semaphores name="S"/></osModel><swModel><tasks name="T" multipleTaskActivationLimit="2"/></swModel>'
    assert compared(tmp_path, body, body, ("2.1.0", "2.2.0")) == [
        ("changed", "Amalthea", "Amalthea", "AMALTHEA version", "2.1.0", "2.2.0")
    ]


def test_default_is_that_of_the_version(tmp_path) -> None:
    body = '<osModel><semaphores name="S"/></osModel>'
    changes = compared(tmp_path, body, body, ("2.0.0", "2.1.0"))
    assert changes[1:] == [("changed", "Semaphore", "S", "maxValue", "0", "1")]
    explicit = body.replace("/></os", ' maxValue="0"/></os')
    assert compared(tmp_path, body, explicit, ("2.0.0", "2.1.0"))[1:] == []


def test_attribute_that_only_one_version_knows_is_not_changed_by_its_default(tmp_path) -> None:
    body = '<osModel><semaphores name="S" maxValue="1"/></osModel>'
    owned = body.replace("maxValue", 'ownership="false" maxValue')
    assert compared(tmp_path, body, body, ("2.2.0", "3.0.0"))[1:] == []
    assert compared(tmp_path, body, owned, ("2.2.0", "3.0.0"))[1:] == [
        ("changed", "Semaphore", "S", "ownership", "unset", "false")
    ]


# Edits


def _insert_call(model: Model, at: int) -> None:
    task(model).activity_graph.items.insert(at % 5, am.RunnableCall(runnable=model[am.Runnable, "R0"]))


def _set(cls, name: str, feature: str, value):
    return lambda model, _: setattr(model[cls, name], feature, value(model))


#: Name -> what is done, and (kind, class, feature) of the one change that it is.
EDITS = {
    "attribute": (_set(am.Task, "T1", "preemption", lambda _: am.Preemption.COOPERATIVE), ("changed", "Task", "preemption")),
    "quantity": (
        lambda m, n: setattr(m[am.PeriodicStimulus, "every_10ms"], "recurrence", am.Time(11 + n, "ms")),
        ("changed", "PeriodicStimulus", "recurrence"),
    ),
    "rename": (lambda m, n: setattr(m[am.Label, f"L{n % 4}"], "name", f"X{n}"), ("changed", "Label", "name")),
    "reference": (
        lambda m, _: setattr(m[am.Runnable, "R2"].activity_graph.items[0], "data", m.root.sw_model.labels[0]),
        ("changed", "LabelAccess", "data"),
    ),
    "call added": (_insert_call, ("added", "RunnableCall", "")),
    "call removed": (lambda m, n: task(m, "T1").activity_graph.items.pop(n % 5), ("removed", "RunnableCall", "")),
    "deep value": (
        lambda m, n: setattr(m[am.Runnable, "R1"].activity_graph.items[1].default, "value", 7 + n),
        ("changed", "DiscreteValueConstant", "value"),
    ),
    "object added": (lambda m, _: m.root.os_model.semaphores.append(am.Semaphore(name="New")), ("added", "Semaphore", "")),
    "object removed": (
        lambda m, _: m.root.os_model.operating_systems.remove(m[am.OperatingSystem, "OS2"]),
        ("removed", "OperatingSystem", ""),
    ),
    "property removed": (lambda m, n: task(m).custom_properties.pop(n % 2), ("removed", "CustomProperty", "")),
    "allocation removed": (lambda m, n: m.root.mapping_model.task_allocation.pop(n % 2), ("removed", "TaskAllocation", "")),
}
MIRRORED = {"added": "removed", "removed": "added", "changed": "changed", "moved": "moved"}
numbers = st.integers(0, 40)


@given(st.sampled_from(sorted(EDITS)), numbers)
def test_one_edit_is_one_change(name: str, number: int) -> None:
    old, new = system(), system()
    edit, expected = EDITS[name]
    edit(new, number)
    assert [(c.kind, c.class_name, c.feature) for c in difference(old, new)] == [expected]


@given(st.sets(st.sampled_from(sorted(EDITS)), min_size=2), numbers)
def test_comparison_is_symmetric(names: set[str], number: int) -> None:
    old, new = system(), system()
    for name in sorted(names):
        EDITS[name][0](new, number)
    there, back = difference(old, new), difference(new, old)
    assert len(there) >= len(names)
    assert Counter((c.kind.value, c.class_name, c.feature) for c in there) == Counter(
        (MIRRORED[c.kind], c.class_name, c.feature) for c in back
    )


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30)
@given(st.sets(st.sampled_from(sorted(EDITS))), numbers)
def test_saving_and_reading_makes_no_difference(tmp_path, names: set[str], number: int) -> None:
    model = system()
    for name in sorted(names):
        EDITS[name][0](model, number)
    save(model, tmp_path / "m.amxmi", canonical=True)
    assert difference(model, load(tmp_path / "m.amxmi")) == []


def test_models_are_left_as_they_are() -> None:
    old, new = system(), system()
    before = {document: set(document.changes.modified) for model in (old, new) for document in model.documents}
    difference(old, new)
    assert {document: set(document.changes.modified) for document in before} == before


def test_nothing_against_everything() -> None:
    nothing = Model([Document(am.Amalthea())])
    kinds = {c.kind for c in difference(nothing, system())}
    assert kinds == {ChangeKind.ADDED}


# Alignment


@given(st.lists(st.integers(0, 5)), st.lists(st.integers(0, 5)))
def test_alignment_pairs_equal_items_in_order(old: list[int], new: list[int]) -> None:
    pairs = align(old, new)
    assert all(old[i] == new[j] for i, j in pairs)
    assert all(a[0] < b[0] and a[1] < b[1] for a, b in itertools.pairwise(pairs))


@given(st.lists(st.integers(0, 3)), st.integers(0, 3), st.data())
def test_alignment_of_one_insertion_is_complete(items: list[int], item: int, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(items)))
    assert len(align(items, [*items[:at], item, *items[at:]])) == len(items)


@given(st.permutations(range(6)))
def test_increasing_subsequence_is_longest(numbers: list[int]) -> None:
    found = [numbers[i] for i in increasing(numbers)]
    assert found == sorted(found)
    chosen = ([n for i, n in enumerate(numbers) if mask >> i & 1] for mask in range(64))
    assert len(found) == max(len(c) for c in chosen if c == sorted(c))
