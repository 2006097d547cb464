"""Renames that depend on each other are reported as renames, in the shortest list of changes."""

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from strategies import parse
from support import model_text

from amalthea_uros.difference.comparison import difference

NAMESPACE = '<commonElements><namespaces name="N"/></commonElements>'


def task(name, runnable, limit=1):
    call = f'<items t="RunnableCall" runnable="{runnable}?type=Runnable"/>'
    return f'<tasks name="{name}" multipleTaskActivationLimit="{limit}"><activityGraph>{call}</activityGraph></tasks>'


def runnable(name, ticks, namespace=""):
    default = f'<default t="DiscreteValueConstant" value="{ticks}"/>'
    inside = f' namespace="{namespace}?type=Namespace"' if namespace else ""
    items = f'<activityGraph><items t="Ticks">{default}</items></activityGraph>'
    return f'<runnables name="{name}"{inside}>{items}</runnables>'


def model(*parts, before=""):
    return parse(model_text(f"{before}<swModel>{''.join(parts)}</swModel>"))


def told(old, new):
    return {(change.feature, change.old, change.new) for change in difference(old, new)}


def test_a_renamed_task_whose_runnable_is_renamed_too():
    old = model(task("T", "R"), runnable("R", 1))
    new = model(task("U", "S"), runnable("S", 1))
    assert told(old, new) == {("name", "T", "U"), ("name", "R", "S")}


def test_runnables_that_are_alike_are_told_apart_by_their_renamed_tasks():
    old = model(task("T1", "R1", 1), task("T2", "R2", 2), runnable("R1", 7), runnable("R2", 7))
    new = model(task("U1", "S1", 1), task("U2", "S2", 2), runnable("S2", 7), runnable("S1", 7))
    assert told(old, new) == {("name", "T1", "U1"), ("name", "T2", "U2"), ("name", "R1", "S1"), ("name", "R2", "S2")}


def test_tasks_that_are_alike_are_told_apart_by_their_renamed_runnables():
    old = model(task("T1", "R1"), task("T2", "R2"), runnable("R1", 1), runnable("R2", 2))
    new = model(task("U2", "S2"), task("U1", "S1"), runnable("S1", 1), runnable("S2", 2))
    assert told(old, new) == {("name", "T1", "U1"), ("name", "T2", "U2"), ("name", "R1", "S1"), ("name", "R2", "S2")}


def test_a_name_that_another_object_had_before():
    old = model(task("T", "A"), task("U", "B"), runnable("A", 1), runnable("B", 2))
    new = model(task("T", "B"), task("U", "C"), runnable("B", 1), runnable("C", 2))
    assert told(old, new) == {("name", "A", "B"), ("name", "B", "C")}


def test_exchanged_values_are_no_exchanged_names():
    old = model(task("T", "A"), task("U", "B"), runnable("A", 1), runnable("B", 2))
    new = model(task("T", "A"), task("U", "B"), runnable("A", 2), runnable("B", 1))
    assert told(old, new) == {("value", "1", "2"), ("value", "2", "1")}


@pytest.mark.parametrize("ticks", [1, 2])
def test_a_namespace_that_is_given_or_taken(ticks):
    outside = model(task("T", "R"), runnable("R", 1), before=NAMESPACE)
    inside = model(task("T", "N/R"), runnable("R", ticks, "N"), before=NAMESPACE)
    value = {("value", "1", "2")} if ticks == 2 else set()
    assert told(outside, inside) == {("namespace", "unset", "N"), *value}
    assert told(inside, outside) == {("namespace", "N", "unset"), *((f, b, a) for f, a, b in value)}


def test_a_namespace_and_a_renamed_user():
    old = model(task("T", "R"), runnable("R", 1), before=NAMESPACE)
    new = model(task("U", "N/R"), runnable("R", 1, "N"), before=NAMESPACE)
    assert told(old, new) == {("name", "T", "U"), ("namespace", "unset", "N")}


@examples(18)
@given(st.permutations(range(6)))
def test_any_permutation_of_names_is_told_as_renames(order):
    def system(names):
        tasks = [task(f"T{number}", name) for number, name in enumerate(names)]
        return model(*tasks, *(runnable(name, number) for number, name in enumerate(names)))

    names = [f"R{number}" for number in range(6)]
    renamed = [f"R{number}" for number in order]
    expected = {("name", a, b) for a, b in zip(names, renamed, strict=True) if a != b}
    assert told(system(names), system(renamed)) == expected
