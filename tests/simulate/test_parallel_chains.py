"""Reactions of chains with parallel parts: one of them is enough, or all are needed."""

from dataclasses import replace
from itertools import pairwise

import pytest
from hand_made_systems import READ, WRITE, Proc, access, system, ticks

from amalthea_uros import analyze_system
from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.perf.constraints import Constraints, LatencyConstraint
from amalthea_uros.perf.events import EventChain, Parallel, ProcessChange, ProcessEvent, Segment, Sequence
from amalthea_uros.perf.software import Label
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US


@pytest.mark.parametrize(("completed", "verdict"), [(1, ObservedVerdict.NOT_OBSERVED), (2, ObservedVerdict.MISSED)])
def test_ways_of_which_only_some_decide(completed, verdict):
    # A starts at 0, and R ends at 4 with what A wrote; B reads it at 10, so that R gets that way only at 20, in the next job.
    names = ("A", "B", "R")
    events = tuple(
        ProcessEvent(name=f"{name} {change}", process=name, change=change)
        for name in names
        for change in (ProcessChange.START, ProcessChange.TERMINATE)
    )
    ways = (("A start", "R terminate"), ("A start", "B terminate", "R terminate"))
    branches = tuple(
        Segment(
            stimulus=way[0],
            response=way[-1],
            items=Sequence(tuple(Segment(stimulus=one, response=other) for one, other in pairwise(way))),
        )
        for way in ways
    )
    chain = EventChain(
        name="ways", stimulus="A start", response="R terminate", items=Parallel(items=branches, completed=completed)
    )
    built = system(
        Proc("A", (ticks(1), access("L", WRITE), access("K", WRITE)), 20, priority=3),
        Proc("B", (access("K", READ), ticks(1), access("M", WRITE)), 20, 10, priority=2),
        Proc("R", (access("L", READ), access("M", READ), ticks(3)), 20, priority=1),
        labels=tuple(Label(name=name) for name in "KLM"),
        events=events,
        chains=(chain,),
    )
    limit = LatencyConstraint(name="limit", chain="ways", maximum=10 * US)
    built = replace(built, constraints=Constraints(constraints=(limit,)))
    (found,) = simulate_system(built, Options(duration=200 * US)).requirements
    assert found.verdict is verdict
    (proved,) = analyze_system(built).requirements
    assert str(proved.verdict) == ("met" if completed == 1 else "unknown")
