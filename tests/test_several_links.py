"""Hops of chains that several links can carry: nobody states which one is meant, so the worst counts, analysed and simulated."""

import pytest
from hand_made_systems import READ, WRITE, Proc, access, chain, system, ticks
from support import SHARED

import amalthea_uros as amuros
from amalthea_uros import analyze_system
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.events import LabelChange, LabelEvent, ProcessChange, ProcessEvent
from amalthea_uros.perf.software import Label
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration

ENDS = (
    ProcessEvent(name="begin", process="writer", change=ProcessChange.START),
    ProcessEvent(name="end", process="reader", change=ProcessChange.TERMINATE),
)


def two_labels(events=ENDS):
    """`early` is there when the reader reads it, 10 us after the writer started; `late` is written 20 us after that start."""
    return system(
        Proc("writer", (ticks(5), access("early", WRITE), ticks(15), access("late", WRITE)), period=100, priority=1),
        Proc("reader", (access("early", READ), access("late", READ), ticks(3)), 100, offset=10, priority=1, scheduler="s1"),
        labels=(Label(name="early"), Label(name="late")),
        events=events,
        chains=(chain("chain", events[0].name, events[-1].name),),
    )


def values(built):
    (found,) = analyze_system(built).chains
    return found, {value.quantity.value: (value.value // US, str(value.claim)) for value in found.values}


def first_to_first(built):
    (observed,) = simulate_system(built, Options(duration=Duration(10 * MS))).chains
    return observed, observed.quantities[ChainQuantity.FIRST_TO_FIRST]


def test_each_label_is_a_route_and_the_worst_counts():
    found, by_name = values(two_labels())
    assert found.routes == ("begin -[data early]-> end", "begin -[data late]-> end")
    # By `early` from 0 to 13; by `late`, which the reader gets a period later, from 0 to 113.
    assert by_name["max_reduced_reaction_time"] == (113, "exact")
    assert by_name["min_first_to_first"] == (13, "exact")
    # There is no mean of both.
    assert not any(name.startswith("mean") for name in by_name)


def test_the_simulation_follows_each_label():
    observed, latency = first_to_first(two_labels())
    assert {route.text for route in observed.routes} == {"begin -[data early]-> end", "begin -[data late]-> end"}
    assert (latency.min, latency.max) == (13 * US, 113 * US)


@pytest.mark.parametrize(("label", "latency"), [("early", 5), ("late", 90)])
def test_events_that_are_accesses_to_the_same_label_say_which_is_meant(label, latency):
    written = LabelEvent(name="written", label=label, change=LabelChange.WRITE)
    read = LabelEvent(name="read", label=label, change=LabelChange.READ)
    found, by_name = values(two_labels((written, read)))
    assert found.routes == (f"written -[data {label}]-> read",)
    # Written at 5 and 20, read at 10 and 110.
    assert by_name["max_reduced_reaction_time"] == (latency, "exact")


def test_a_trigger_and_data_are_two_routes():
    built = system(
        Proc("writer", (ticks(5), Trigger(stimulus="go"), ticks(15), access("data", WRITE)), period=100, priority=1),
        Proc("reader", (access("data", READ), ticks(3)), stimuli=("go",), priority=1, scheduler="s1"),
        labels=(Label(name="data"),),
        triggers=("go",),
        events=ENDS,
        chains=(chain("chain", "begin", "end"),),
    )
    found, by_name = values(built)
    assert found.routes == ("begin -[a trigger go]-> end", "begin -[data data]-> end")
    # The reader starts when it is triggered, at 5, before the data are written: it gets them 105 us after the writer started.
    assert by_name.get("max_reduced_reaction_time", (108,))[0] >= 108
    _, latency = first_to_first(built)
    assert (latency.min, latency.max) == (8 * US, 108 * US)


def test_a_mode_beside_data_hides_them_nowhere():
    model = SHARED / "vectors" / "verdicts" / "mode-beside-data.amxmi"
    (limit,) = amuros.analyze(model).requirements
    # Both are written at 2 us and read by 12 us.
    assert (str(limit.verdict), limit.lower, limit.upper) == ("missed", 12 * US, 12 * US)
    (observed,) = amuros.simulate(model, "10 ms").requirements
    assert (str(observed.verdict), observed.value) == ("observed_missed", 12 * US)
