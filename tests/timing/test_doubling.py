"""Systems in which each part refers twice to the next one are counted once, although what they describe doubles with each part."""

from itertools import permutations

import pytest
from hand_made_systems import READ, WRITE, Proc, access, ticks
from hand_made_systems import system as build

from amalthea_uros import analyze_system
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.activities import Call, Chance, Group, ProbabilitySwitch
from amalthea_uros.perf.events import (
    ChainReference,
    EventChain,
    Parallel,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
    Segment,
    Sequence,
)
from amalthea_uros.perf.software import Label, Runnable
from amalthea_uros.timing.dataflow import paths as dataflow_paths
from amalthea_uros.timing.dataflow.chains import unfold
from amalthea_uros.timing.dataflow.events import EventLocator
from amalthea_uros.timing.dataflow.paths import paths
from amalthea_uros.timing.jobs.counters import CallSites, reached
from amalthea_uros.timing.jobs.positions import positions
from amalthea_uros.units import MICROSECOND as US


def calling(depth, times=2, **others):
    """A task whose runnables call the next one several times each; the last one takes a microsecond."""
    runnables = [Runnable(name=f"R{n}", activities=(Call(runnable=f"R{n + 1}"),) * times) for n in range(depth)]
    last = Runnable(name=f"R{depth}", activities=(ticks(1),))
    return build(Proc("T", (Call(runnable="R0"),), 10_000), runnables=(*runnables, last), **others)


class TestCalls:
    def test_the_demand_of_doubled_calls(self):
        # 2^12 executions of a microsecond.
        (task,) = analyze_system(calling(12)).processes
        assert task.wcet == 2**12 * US

    def test_many_calls_and_deep_calls(self):
        (wide,), (deep,) = (analyze_system(calling(*shape)).processes for shape in ((6, 40), (5000, 1)))
        assert (wide.wcet, deep.wcet) == (40**6 * US, US)
        assert (wide.verdict, deep.verdict) == (Verdict.UNBOUNDED, Verdict.MET)

    def test_a_demand_beyond_all_limits_is_never_met(self):
        (task,) = analyze_system(calling(300)).processes
        assert task.verdict is not Verdict.MET

    def test_an_event_inside_too_many_calls_is_not_located(self, monkeypatch):
        followed = []
        monkeypatch.setattr("amalthea_uros.timing.jobs.positions._Walk.through", lambda *_: followed.append(1))
        event = RunnableEvent(name="end", runnable="R60", change=RunnableChange.TERMINATE)
        locator = EventLocator(calling(60, events=(event,)))
        for _ in range(3):
            with pytest.raises(UnknownError, match="too many calls"):
                locator.of(event)
        assert not followed

    @pytest.mark.parametrize(
        "body",
        [
            (ticks(1), Call(runnable="R0"), Call(runnable="R3")),
            (Group(activities=(Call(runnable="R2"), ticks(1))), Call(runnable="missing")),
            (ProbabilitySwitch(branches=(Chance(weight=1.0, activities=(Call(runnable="R0"),)),) * 2),),
        ],
    )
    def test_the_number_of_activities_is_that_of_their_positions(self, body):
        system = calling(4)
        process = build(Proc("P", body, 1000)).processes["P"]
        sites = CallSites(system)
        assert reached(process.activities, sites.sizes) == len(positions(process, system, sites))


START, END = (
    ProcessEvent(name=str(change), process="T", change=change) for change in (ProcessChange.START, ProcessChange.TERMINATE)
)


def referring(depth, items):
    """Chains that each refer to the next one in some way."""
    ends = {"stimulus": START.name, "response": END.name}
    chains = [EventChain(name=f"c{n}", items=items(ChainReference(chain=f"c{n + 1}")), **ends) for n in range(depth)]
    return build(Proc("T", (ticks(1),), 1000), events=(START, END), chains=(*chains, EventChain(name=f"c{depth}", **ends)))


class TestChains:
    @pytest.mark.parametrize(
        "items",
        [
            lambda reference: Sequence(items=(reference, reference)),
            lambda reference: Parallel(items=(reference, reference), completed=1),
            lambda reference: Parallel(items=(reference, Segment(items=Parallel(items=(reference,) * 3)))),
        ],
    )
    def test_references_that_double(self, items):
        system = referring(200, items)
        with pytest.raises(UnknownError, match="more than"):
            unfold(system.chains["c0"], system)
        # What the last ones describe is small.
        assert unfold(system.chains["c199"], system)[0]

    def test_a_long_way_of_references(self):
        system = referring(5000, lambda reference: Sequence(items=(reference,)))
        assert unfold(system.chains["c0"], system) == (("start", "terminate"), ())

    def test_a_circle_of_references(self):
        chains = tuple(
            EventChain(name=f"c{n}", items=Sequence(items=(ChainReference(chain=f"c{(n + 1) % 3000}"),))) for n in range(3000)
        )
        system = build(Proc("T", (ticks(1),), 1000), events=(START, END), chains=chains)
        with pytest.raises(UnknownError, match=r"^it contains itself: c0 -> c1 -> c2 .*-> c2999 -> c0$"):
            unfold(chains[0], system)


def linked(links):
    """Processes of which each writes a label for each process that it is linked to."""
    names = sorted({name for link in links for name in link})
    bodies = {name: [ticks(1)] for name in names}
    for writer, reader in links:
        bodies[writer].append(access(f"{writer}-{reader}", WRITE))
        bodies[reader].insert(0, access(f"{writer}-{reader}", READ))
    return build(
        *(Proc(name, tuple(body), 1000) for name, body in bodies.items()),
        labels=tuple(Label(name=f"{writer}-{reader}") for writer, reader in links),
    )


CLIQUE = list(permutations("ABCDEFGHIJKLMNOP", 2))


class TestPaths:
    def test_an_end_that_nothing_reaches(self):
        found = paths(linked([*CLIQUE, ("Z", "A")]), "A", "Z")
        assert (found.found, found.are_all) == ((), True)

    def test_an_end_behind_the_start(self):
        # Only A leads to Z, and no path passes A again.
        found = paths(linked([*CLIQUE, ("A", "Z")]), "A", "Z")
        assert [path.processes for path in found.found] == [("A", "Z")]
        assert found.are_all

    def test_more_paths_than_are_listed(self):
        found = paths(linked(CLIQUE), "A", "P")
        assert len(found.found) == dataflow_paths.MAX_PATHS
        assert not found.are_all

    @pytest.mark.parametrize(
        "links", [[("A", "B"), ("B", "C"), ("A", "C")], list(permutations("ABCD", 2)), [*permutations("ABC", 2), ("C", "D")]]
    )
    def test_all_paths_are_found(self, links):
        names = sorted({name for link in links for name in link})
        every = {
            ("A", *between, names[-1])
            for count in range(len(names) - 1)
            for between in permutations(names[1:-1], count)
            if all(step in links for step in zip(("A", *between), (*between, names[-1]), strict=True))
        }
        found = paths(linked(links), "A", names[-1])
        assert {path.processes for path in found.found} == every
        assert found.are_all
