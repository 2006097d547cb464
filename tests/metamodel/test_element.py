"""Objects in code: created, put into each other, looked up."""

import copy

import pytest

from amalthea_uros import Model
from amalthea_uros.am import (
    ActivityGraph,
    Amalthea,
    Group,
    HWModel,
    HwPort,
    HwStructure,
    Label,
    LabelAccess,
    OSModel,
    PeriodicStimulus,
    Preemption,
    Process,
    Runnable,
    RunnableCall,
    Semaphore,
    SWModel,
    Task,
    Time,
    TimeUnit,
)


def test_creating_reads_well():
    task = Task(name="t", preemption=Preemption.PREEMPTIVE, stimuli=[PeriodicStimulus(name="p", recurrence=Time(10, "ms"))])
    assert task.preemption == "preemptive"
    assert (task.stimuli[0].recurrence.value, task.stimuli[0].recurrence.unit) == (10, TimeUnit.MS)
    assert repr(task) == "<Task 't', every 10 ms>"


def test_unset_is_unset():
    task = Task()
    assert (task.name, task.preemption, task.stimuli, task.activity_graph) == (None, None, [], None)


def test_defaults_are_those_of_the_version():
    old, new = (Model.of(Amalthea(os_model=OSModel(semaphores=[Semaphore(name="s")])), v) for v in ("2.0.0", "2.1.0"))
    assert [model[Semaphore, "s"].effective("max_value") for model in (old, new)] == [0, 1]
    assert Task().effective("preemption") is Preemption.UNDEFINED
    assert Task().effective("name") == ""


@pytest.mark.parametrize(
    ("action", "error", "words"),
    [
        (lambda: Task(prority=3), AttributeError, "Task has no feature 'prority'"),
        (lambda: setattr(Task(), "preemtion", 1), AttributeError, "did you mean 'preemption'"),
        (lambda: Time(10, "msec"), ValueError, "expected one of s, ms, us, ns, ps"),
        (lambda: Process(name="p"), TypeError, "Process is abstract"),
        (lambda: SWModel(tasks=["T"]), TypeError, "not a model object"),
        (lambda: ActivityGraph(items=[RunnableCall()]).items * 2 and ActivityGraph().items.__imul__(2), TypeError, "only once"),
    ],
)
def test_mistakes_are_told(action, error, words):
    with pytest.raises(error, match=words):
        action()


class TestContainment:
    def test_is_known_from_both_ends(self):
        graph = ActivityGraph()
        task = Task(name="t", activity_graph=graph)
        call = RunnableCall()
        graph.items.append(call)
        assert graph.container is task
        assert call.container is graph
        assert call.enclosing(Task) is task
        assert list(task.walk()) == [task, graph, call]

    def test_an_object_has_one_container(self):
        first, second = SWModel(labels=[Label(name="a")]), SWModel()
        label = first.labels[0]
        second.labels.append(label)
        assert (first.labels, second.labels, label.container) == ([], [label], second)

    def test_so_it_has_in_a_list_that_is_assigned(self):
        first = SWModel(labels=[Label(name="a"), Label(name="b")])
        a, b = first.labels
        first.labels = [b, a]
        assert first.labels == [b, a]
        second = SWModel(labels=first.labels)
        assert (first.labels, a.container) == ([], second)

    def test_single_parts_move_too(self):
        graph = ActivityGraph()
        one, other = Runnable(activity_graph=graph), Runnable()
        other.activity_graph = graph
        assert (one.activity_graph, graph.container) == (None, other)
        other.activity_graph = None
        assert graph.container is None

    def test_no_object_contains_itself(self):
        outer, inner = Group(), Group()
        outer.items.append(inner)
        with pytest.raises(ValueError, match="cannot become a part"):
            inner.items.append(outer)

    @pytest.mark.parametrize(
        "action",
        [
            lambda parts: parts.pop(),
            lambda parts: parts.remove(parts[2]),
            lambda parts: parts.__delitem__(2),
            lambda parts: parts.__delitem__(slice(2, None)),
            lambda parts: parts.__setitem__(slice(2, 3), []),
        ],
    )
    def test_what_is_taken_out_has_none(self, action):
        parts = SWModel(labels=[Label(name=n) for n in "abc"]).labels
        last = parts[2]
        action(parts)
        assert [label.name for label in parts] == ["a", "b"]
        assert last.container is None

    def test_replacing_and_inserting(self):
        model = SWModel(labels=[Label(name=n) for n in "abc"])
        model.labels[1] = Label(name="x")
        model.labels.insert(0, Label(name="y"))
        model.labels += [Label(name="z")]
        assert [label.name for label in model.labels] == ["y", "a", "x", "c", "z"]
        assert {label.container for label in model.labels} == {model}

    def test_a_slice_is_an_ordinary_list(self):
        parts = SWModel(labels=[Label(name=n) for n in "abc"]).labels
        assert type(copy.copy(parts)) is list
        assert parts[:1][0].container is not None


class TestCopies:
    def test_a_deep_copy_is_detached_and_complete(self):
        runnable = Runnable(name="R")
        group = Group(name="g", items=[RunnableCall(runnable=runnable)])
        task = Task(name="T", activity_graph=ActivityGraph(items=[group]))
        twin = copy.deepcopy(group)
        assert (twin.name, twin.container, group.container) == ("g", None, task.activity_graph)
        assert twin.items[0] is not group.items[0]
        assert twin.items[0].container is twin
        assert twin.items[0].runnable is runnable
        twin.items.append(RunnableCall())
        assert len(group.items) == 1

    def test_references_within_lead_to_the_copies(self):
        label = Label(name="L")
        software = SWModel(labels=[label], runnables=[Runnable(activity_graph=ActivityGraph(items=[LabelAccess(data=label)]))])
        twin = copy.deepcopy(software)
        assert twin.runnables[0].activity_graph.items[0].data is twin.labels[0]

    def test_a_shallow_copy_is_refused(self):
        with pytest.raises(TypeError, match=r"use copy\.deepcopy"):
            copy.copy(Task(name="T"))


class TestLookup:
    @pytest.fixture
    def model(self):
        software = SWModel(tasks=[Task(name="T"), Task(name="U")], runnables=[Runnable(name="T")])
        hardware = HwStructure(name="Board", ports=[HwPort(name="eth0")])
        model = Model.of(Amalthea(sw_model=software))
        model.root.hw_model = HWModel(structures=[hardware])
        return model

    def test_by_class_and_name(self, model):
        assert model.find(Task, "T") is model.root.sw_model.tasks[0]
        assert model.find(Runnable, "T") is model.root.sw_model.runnables[0]
        assert model.find(Task, "V") is None
        assert model.find(HwPort, "Board.eth0") is model.find(HwPort, "eth0")

    def test_by_class(self, model):
        assert [task.name for task in model.all(Process)] == ["T", "U"]

    def test_a_missing_name_suggests_near_ones(self, model):
        model.root.sw_model.tasks.append(Task(name="Executor_Task"))
        with pytest.raises(KeyError, match="no Task named 'Executor_Tsk'; did you mean 'Executor_Task'"):
            model[Task, "Executor_Tsk"]

    def test_after_changes(self, model):
        task = model[Task, "T"]
        task.name = "X"
        assert model.find(Task, "T") is None
        assert model[Task, "X"] is task
        model.root.sw_model.tasks.remove(task)
        assert model.find(Task, "X") is None

    def test_the_uses_of_an_object(self, model):
        runnable = model[Runnable, "T"]
        call = RunnableCall(runnable=runnable)
        model[Task, "U"].activity_graph = ActivityGraph(items=[call])
        assert model.references_to(runnable) == [(call, "runnable")]
