"""The activities that raise an event are found by what they access."""

from effort import examples
from hypothesis import given
from system_strategies import systems

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import AccessKind, Call, Group, LabelAccess, RaiseEvent
from amalthea_uros.perf.events import CustomEvent, LabelChange, LabelEvent, RunnableEvent
from amalthea_uros.perf.software import Runnable, Software, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import EventLocator, raises


@given(systems())
@examples(14)
def test_they_are_those_that_a_look_at_each_activity_finds(system):
    locator = EventLocator(system)
    try:
        everything = list(locator.all_positions())
    except UnknownError:
        return
    for event in system.events.events:
        assert locator.raising(event) == [position for position in everything if raises(position, event)]


READ = LabelAccess(label="L", kind=AccessKind.READ)
SYSTEM = System(
    software=Software(
        tasks=(
            Task(name="A", activities=(Call(runnable="R"), Group(activities=(READ, RaiseEvent(event="E"))))),
            Task(name="B", activities=(READ, Call(runnable="R"))),
        ),
        runnables=(Runnable(name="R", activities=(READ, LabelAccess(label="M", kind=AccessKind.WRITE))),),
    )
)


def raising(event):
    return [(position.process.name, position.number) for position in EventLocator(SYSTEM).raising(event)]


def test_unset_features_of_an_event_match_everything():
    assert raising(LabelEvent(name="e", label="L")) == [("A", 2), ("A", 5), ("B", 1), ("B", 3)]
    assert raising(LabelEvent(name="e", label="L", process="B", change=LabelChange.READ)) == [("B", 1), ("B", 3)]
    assert raising(LabelEvent(name="e", label="L", runnable="R")) == [("A", 2), ("B", 3)]
    assert raising(LabelEvent(name="e", process="A")) == [("A", 2), ("A", 3), ("A", 5)]
    assert raising(LabelEvent(name="e", label="L", process="missing")) == []
    assert raising(RunnableEvent(name="e", runnable="R")) == raising(RunnableEvent(name="e")) == [("A", 1), ("B", 2)]
    assert raising(CustomEvent(name="E")) == [("A", 6)]
