"""Chains whose events have no type: bounds for each of the types that they may have.

All tasks run at 1 MHz, so that a tick takes 1 us.
"""

from dataclasses import replace
from itertools import product

import pytest
from hand_made_systems import Proc, access, chain, system, ticks

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import AccessKind, Call, Communication
from amalthea_uros.perf.events import ProcessChange, ProcessEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.software import Runnable
from amalthea_uros.timing.dataflow.untyped_events import ASSUMPTION
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US

TYPES = (ProcessChange.ACTIVATE, ProcessChange.START, ProcessChange.TERMINATE)
EXPLICIT, IMPLICIT = Communication.EXPLICIT, Communication.IMPLICIT


def built(first=None, then=None, *, offset=20, how=IMPLICIT):
    """A writer of 10 us every 100 us, and a reader of 5 us that reads after 2 us; each on a core of its own."""
    return system(
        Proc("Writer", (ticks(10), access("x", AccessKind.WRITE, how)), 100, priority=1),
        Proc("Reader", (ticks(2), access("x", AccessKind.READ, how), ticks(3)), 100, offset, priority=1, scheduler="s1"),
        events=(
            ProcessEvent(name="first", process="Writer", change=first),
            ProcessEvent(name="then", process="Reader", change=then),
        ),
        chains=(chain("flow", "first", "then"),),
    )


def values(described):
    """The maxima of the chain in us."""
    found = analyze_system(described).chains["flow"].values
    return {str(each.quantity): each.value // US for each in found if each.quantity.is_upper}


def test_mostly_from_the_activation_to_the_end():
    # Activated at 0 and written at 10, read at 20, ended at 25; an input just after the activation waits for the next one.
    found = values(built())
    assert (found["max_reduced_reaction_time"], found["max_reaction_time"]) == (25, 125)


def test_another_reading_can_be_longer():
    # The job that starts at 9 reads what was written at 10, but its start comes before the end of the writer; the next one is at 109.
    typed = values(built(ProcessChange.TERMINATE, ProcessChange.START, offset=9, how=EXPLICIT))
    assert typed["max_reduced_reaction_time"] >= 99
    assert (
        values(built(ProcessChange.ACTIVATE, ProcessChange.TERMINATE, offset=9, how=EXPLICIT))["max_reduced_reaction_time"]
        == 14
    )
    assert values(built(offset=9, how=EXPLICIT))["max_reduced_reaction_time"] >= 99


@pytest.mark.parametrize("how", [EXPLICIT, IMPLICIT, Communication.LET])
@pytest.mark.parametrize("offset", [0, 9, 20, 95])
def test_no_type_exceeds_the_bounds(offset, how):
    bounds = values(built(offset=offset, how=how))
    assert bounds
    for first, then in product(TYPES, repeat=2):
        typed = values(built(first, then, offset=offset, how=how))
        assert all(typed.get(quantity, 0) <= bound for quantity, bound in bounds.items())


def test_only_upper_bounds_with_the_assumption():
    analysis = analyze_system(built())
    found = analysis.chains["flow"]
    assert {(each.claim, each.quantity.is_upper) for each in found.values} == {(Claim.BOUND, True)}
    assert found.why == "bounds: events of the chain have no type"
    assert ASSUMPTION in analysis.assumptions
    assert ASSUMPTION not in analyze_system(built(*TYPES[::2])).assumptions


def test_an_event_of_a_runnable_is_its_start_or_its_end():
    def described(change):
        once = replace(
            built(),
            software=replace(
                built().software, runnables=(Runnable(name="R", activities=(access("x", AccessKind.READ, IMPLICIT), ticks(3))),)
            ),
        )
        reader = replace(once.software.tasks[1], activities=(ticks(2), Call(runnable="R")))
        tasks = (once.software.tasks[0], reader)
        event = RunnableEvent(name="then", runnable="R", change=change)
        events = replace(once.events, events=(once.events.events[0], event))
        return replace(once, software=replace(once.software, tasks=tasks), events=events)

    ends = [
        values(described(change))["max_reduced_reaction_time"] for change in (RunnableChange.START, RunnableChange.TERMINATE)
    ]
    # From the activation at 0 to the call from 22 to 25.
    assert values(described(None))["max_reduced_reaction_time"] == max(ends) == 25
