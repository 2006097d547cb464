"""Triggers on paths that exclude each other: a job takes one path, so that only what that one triggers is demanded.

All tasks run at 1 MHz, so that a tick takes 1 us. A is activated every 100 us and executes 10 us, in all examples.
"""

from fractions import Fraction
from itertools import product

import pytest
from effort import examples
from hand_made_systems import Proc, one_core, system, ticks
from hypothesis import given
from hypothesis import strategies as st
from support import SHARED, analysis_of

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.activities import Case, Chance, Group, ProbabilitySwitch, Switch, Trigger
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.stimuli import Counter, InterProcess
from amalthea_uros.units import MICROSECOND as US


def trigger(name, every=None):
    return Trigger(stimulus=f"trigger {name}", counter=None if every is None else Counter(prescaler=every))


def by_chance(*branches):
    return ProbabilitySwitch(branches=tuple(Chance(weight=0.5, activities=tuple(branch)) for branch in branches))


def by_mode(*branches):
    return Switch(cases=tuple(Case(activities=tuple(branch)) for branch in branches[:-1]), default=tuple(branches[-1]))


def analysed(*activities, period=100, others=(), **triggered):
    """A with some activities after its own, and the tasks that it triggers with their ticks or activities, the highest first."""
    stimuli = [InterProcess(name=f"trigger {name}") for name in triggered]
    tasks = [(name, None, [ticks(body)] if isinstance(body, int) else body) for name, body in triggered.items()]
    return analyze_system(one_core(("A", period, [ticks(10), *activities]), *tasks, *others, stimuli=stimuli))


def percent(analysis):
    (core,) = analysis.processors
    return tuple(None if load is None else 100 * load for load in (core.best, core.mean, core.worst, core.at_least))


def test_an_overload_of_a_little_is_not_shown_as_a_full_core():
    # 10 us and one of 9,991 us in each 10 ms.
    analysis = analysed(by_chance([trigger("B")], [trigger("C")]), B=9_991, C=9_991, period=10_000)
    assert analysis["C"].reason == "overload: tasks at this priority or higher need 100.01 % of the core"


def test_one_of_two_triggers_by_chance():
    analysis = analysis_of(SHARED / "vectors" / "verdicts" / "exclusive-triggers.amxmi")
    assert percent(analysis) == (60, 60, 60, 60)
    assert not any(process.response.is_overload for process in analysis.processes)
    # Of A and the one that it triggers, 1 ms and 5 ms, both end within 6 ms.
    assert [process.response.worst for process in analysis.processes] == [1000 * US, 6000 * US, 6000 * US]


@pytest.mark.parametrize(
    ("activities", "expected"),
    [
        # 10 us of A, and 30 us of B or 50 us of C, or 40 us on average.
        pytest.param([by_chance([trigger("B")], [trigger("C")])], (40, 50, 60, 60), id="chance"),
        # A mode may exclude C for ever, so that only 30 us are certain to occur.
        pytest.param([by_mode([trigger("B")], [trigger("C")])], (40, 50, 60, 40), id="modes"),
        # The longer own branch triggers the shorter task: 25 + 30 or 1 + 50.
        pytest.param([by_chance([ticks(25), trigger("B")], [ticks(1), trigger("C")])], (61, 63, 65, 65), id="own branches"),
        # Nothing, or both, or one of them.
        pytest.param(
            [by_chance([], [by_chance([trigger("B"), trigger("C")], [trigger("C")])])], (10, 42.5, 90, 90), id="nested"
        ),
        # Every second time that the branch is taken: 25 us for each of them.
        pytest.param([by_chance([trigger("B")], [trigger("C", every=2)])], (35, 37.5, 40, 40), id="prescaler"),
        pytest.param([Group(activities=(trigger("B"),)), by_chance([trigger("C")], [])], (40, 65, 90, 90), id="group"),
    ],
)
def test_the_load_is_that_of_the_paths(activities, expected):
    assert percent(analysed(*activities, B=30, C=50)) == expected


def test_both_branches_trigger_the_same_task():
    # B is activated once for each job of A, and ends 10 us + 60 us after that at the latest.
    analysis = analysed(by_chance([trigger("B")], [ticks(1), trigger("B")]), B=60)
    assert percent(analysis) == (70, Fraction(141, 2), 71, 71)
    assert analysis.processes["B"].response.worst <= 71 * US


def test_what_is_triggered_further_belongs_to_the_path():
    analysis = analysed(by_chance([trigger("B")], [trigger("C")]), B=[ticks(20), trigger("D")], C=50, D=35)
    # 10 + 20 + 35, or 10 + 50.
    assert percent(analysis) == (60, 62.5, 65, 65)


def test_a_task_below_those_that_exclude_each_other_is_not_overloaded():
    found = analysed(by_chance([trigger("B")], [trigger("C")]), B=50, C=50, others=[("D", 100, [ticks(30)])]).processes["D"]
    # At worst a job of each: 10 + 50 + 30.
    assert (found.response.worst, found.verdict) == (90 * US, Verdict.MET)


def test_one_path_alone_overloads_the_core():
    analysis = analysed(by_chance([trigger("B")], [trigger("C")]), B=95, C=50)
    assert percent(analysis) == (60, 82.5, 105, 105)
    assert [process.name for process in analysis.processes if process.verdict is Verdict.UNBOUNDED] == ["B", "C"]


def test_modes_that_may_exclude_the_overload_leave_it_open():
    analysis = analysed(by_mode([trigger("B")], [trigger("C")]), B=95, C=50)
    assert percent(analysis) == (60, 82.5, 105, 60)
    assert analysis.processes["B"].verdict is Verdict.UNKNOWN
    assert "unless modes exclude" in analysis.processes["B"].reason


# All paths, one by one

DEMANDS = {"B": 2, "C": 3, "D": 5}
LEAVES = st.integers(1, 4).map(ticks) | st.sampled_from(sorted(DEMANDS)).map(trigger)


def within(inner):
    body = st.lists(inner, max_size=2)
    chances = st.lists(body, min_size=1, max_size=3).map(lambda branches: by_chance(*branches))
    modes = st.lists(body, min_size=2, max_size=3).map(lambda branches: by_mode(*branches))
    return chances | modes | body.map(lambda activities: Group(activities=tuple(activities)))


def paths(activities):
    """What is executed and triggered on every path through some activities."""
    for parts in product(*map(list, map(paths_of, activities))):
        yield [leaf for part in parts for leaf in part]


def paths_of(activity):
    match activity:
        case Group(activities=inner):
            yield from paths(inner)
        case ProbabilitySwitch(branches=branches):
            for branch in branches:
                yield from paths(branch.activities)
        case Switch(cases=cases, default=default):
            for inner in (*(case.activities for case in cases), default):
                yield from paths(inner)
        case _:
            yield [activity]


def demand(leaf):
    return DEMANDS[leaf.stimulus.removeprefix("trigger ")] if isinstance(leaf, Trigger) else leaf.demand.ticks.value


@examples(36)
@given(st.lists(st.recursive(LEAVES, within, max_leaves=7), max_size=3))
def test_the_load_of_random_paths(activities):
    found = percent(analysed(*activities, **DEMANDS))
    every = [10 + sum(map(demand, path)) for path in paths(activities)]
    used = {leaf.stimulus for path in paths(activities) for leaf in path if isinstance(leaf, Trigger)}
    if len(used) == len(DEMANDS):
        assert (found[0], found[2]) == (min(every), max(every))
    assert found[3] <= max(every)


def test_a_trigger_in_any_order_comes_at_any_time_of_its_job():
    """A job of 3 us triggers at its end, the next one 5 us later at its start: 2 us apart, so that B of 3 us waits for 1 us."""
    group = Group(ordered=False, activities=(ticks(3), Trigger(stimulus="b")))
    found = system(
        Proc("A", (group,), 5),
        Proc("B", (ticks(3),), stimuli=("b",), scheduler="s1"),
        schedulers=[
            Scheduler(name="s0", policy=Policy.OSEK, cores=("c0",)),
            Scheduler(name="s1", policy=Policy.OSEK, cores=("c1",)),
        ],
        triggers=("b",),
    )
    analysis = analyze_system(found)
    assert analysis.processes["B"].response.worst >= 4 * US
