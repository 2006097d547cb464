"""Unique names as APP4MC makes them, qualified names as people read them."""

import pytest

from amalthea_uros.am import (
    ActivityGraph,
    CallArgument,
    Component,
    ComponentPort,
    EnumMode,
    HwConnection,
    HwFeature,
    HwFeatureCategory,
    HwPort,
    HwStructure,
    Label,
    MainInterface,
    ModeLiteral,
    Namespace,
    Runnable,
    RunnableCall,
    RunnableParameter,
    SubInterface,
    Task,
    Time,
)


def within(container, feature, part):
    getattr(container, feature).append(part)
    return part


SPACE = Namespace(name="a", next_segments=[Namespace(name="b c")])
READER = Runnable(name="R", parameters=[RunnableParameter(name="p")])


def call_argument():
    argument = CallArgument(name="x", parameter=READER.parameters[0])
    call = RunnableCall(runnable=READER, arguments=[argument])
    Task(name="T", activity_graph=ActivityGraph(items=[call]))
    return argument


@pytest.mark.parametrize(
    ("element", "unique", "qualified"),
    [
        (Task(name="Lidar"), "Lidar?type=Task", "Lidar"),
        (Task(name="a b+c/d:e?(f)~ß"), "a+b%2Bc%2Fd%3Ae%3F%28f%29%7E%C3%9F?type=Task", "a b+c/d:e?(f)~ß"),
        (Label(name="a.b-c_d*e"), "a.b-c_d*e?type=Label", "a.b-c_d*e"),
        (Label(), "no-name?type=Label", "no-name"),
        (
            within(HwStructure(name="RaspberryPi_1"), "ports", HwPort(name="eth0")),
            "RaspberryPi_1/eth0?type=HwPort",
            "RaspberryPi_1.eth0",
        ),
        (
            within(HwStructure(name="E/E_System"), "connections", HwConnection(name="con1")),
            "E%2FE_System/con1?type=HwConnection",
            None,
        ),
        (
            within(HwFeatureCategory(name="Instructions"), "features", HwFeature(name="IPC")),
            "Instructions/IPC?type=HwFeature",
            None,
        ),
        (within(EnumMode(name="M"), "literals", ModeLiteral(name="on")), "M/on?type=ModeLiteral", None),
        (within(Component(name="C", namespace=SPACE), "ports", ComponentPort(name="p")), "a/C/p?type=ComponentPort", "a.C.p"),
        (within(MainInterface(name="I"), "sub_interfaces", SubInterface(name="s")), "I/s?type=SubInterface", None),
        (SPACE.next_segments[0], "a/b+c?type=Namespace", None),
        (Runnable(name="r", namespace=SPACE.next_segments[0]), "a/b+c/r?type=Runnable", "a.b c.r"),
        (READER.parameters[0], "R/p?type=RunnableParameter", None),
        (call_argument(), "T/calls/R/param/p/x?type=CallArgument", None),
    ],
)
def test_names(element, unique, qualified):
    assert element.unique_name == unique
    assert qualified is None or element.qualified_name == qualified


def test_nested_structures_do_not_nest_their_names():
    inner = HwStructure(name="inner", ports=[HwPort(name="p")])
    HwStructure(name="outer", structures=[inner])
    assert inner.ports[0].unique_name == "inner/p?type=HwPort"


def test_an_object_without_a_name_is_called_by_its_place():
    runnable = Runnable(name="R", activity_graph=ActivityGraph(items=[RunnableCall(), RunnableCall()]))
    assert runnable.activity_graph.items[1].qualified_name == "R.activityGraph.items[1]"
    assert Time(1, "ms").qualified_name == "Time"
