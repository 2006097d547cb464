"""Orders of runnables that several processes execute: what the analysis proves, and what a simulation observes.

All runnables take 1 ms; A has the higher priority. The k-th executions of the runnables belong together.
"""

import pytest
from hand_made_systems import ticks
from test_observers import simulated, system

from amalthea_uros import analyze_system
from amalthea_uros.perf.activities import Call, Chance, Group, ProbabilitySwitch, Trigger
from amalthea_uros.perf.constraints import OrderConstraint, Ordering

SOMETIMES_B = ProbabilitySwitch(branches=(Chance(weight=1, activities=(Call(runnable="b"),)), Chance(weight=1, activities=())))
A_THEN_B, B_THEN_A = (("a",), ("b",)), (("b",), ("a",))


def answers(bodies, groups, *, ordering=Ordering.SUCCESSOR, scope=(), **more):
    """Of each result the processes, and the verdicts of analysis and simulation."""
    order = OrderConstraint(name="O", groups=tuple(map(tuple, groups)), ordering=ordering, processes=scope)
    called = {
        process: [Call(runnable=each) if isinstance(each, str) else each for each in body] for process, body in bodies.items()
    }
    model = system(called, runnables={name: [ticks(1000)] for name in "abcd"}, orders=(order,), **more)
    proved = {each.object: str(each.verdict) for each in analyze_system(model).requirements}
    observed = {each.object: str(each.verdict) for each in simulated(model).requirements}
    assert proved.keys() == observed.keys()
    return {what: (proved[what], observed[what]) for what in proved}


def every(period, **offsets):
    return {"periods": dict.fromkeys("AB", period), "offsets": {name: value * 1000 for name, value in offsets.items()}}


@pytest.mark.parametrize(
    ("offset", "groups", "expected"),
    [
        # a runs from 0 to 1 ms, b from 5 to 6 ms.
        (5, A_THEN_B, ("met", "observed_ok")),
        (5, B_THEN_A, ("missed", "observed_missed")),
        # Both are activated at once. A runs first, which the bounds on B, from 0 to 2 ms, do not say.
        (0, A_THEN_B, ("unknown", "observed_ok")),
        (0, B_THEN_A, ("unknown", "observed_missed")),
        # b is activated exactly when a ends.
        (1, A_THEN_B, ("met", "observed_ok")),
        # The first b is in the second period: it follows the first a, which ended long before.
        (15, A_THEN_B, ("met", "observed_ok")),
    ],
)
@pytest.mark.parametrize("cores", [{}, {"B": "c1"}], ids=["one core", "two cores"])
def test_an_order_across_tasks_of_the_same_period(offset, groups, expected, cores):
    if cores and offset == 0:
        # On cores of their own, a and b run at the same time.
        expected = ("unknown", "observed_missed")
    assert answers({"A": ["a"], "B": ["b"]}, groups, cores=cores, **every(10, B=offset)) == {"A, B": expected}


@pytest.mark.parametrize(("ordering", "groups", "expected"), [
    (Ordering.IMMEDIATE_ANYWHERE, A_THEN_B, ("unknown", "not_observed")),
    (Ordering.IMMEDIATE_AT_START, A_THEN_B, ("unknown", "not_observed")),
    (Ordering.IMMEDIATE_AT_END, B_THEN_A, ("missed", "observed_missed")),
])  # fmt: skip
def test_across_tasks_nobody_observes_what_is_executed_in_between(ordering, groups, expected):
    """Neither proves that a and b follow each other immediately; both see that they are in another order."""
    assert answers({"A": ["a"], "B": ["b"]}, groups, ordering=ordering, **every(10, B=5)) == {"A, B": expected}


@pytest.mark.parametrize(
    ("bodies", "groups", "expected"),
    [
        # a, c in any order from 0 to 2 ms, then b, d from 5 to 7 ms.
        ({"A": "ac", "B": "bd"}, ("ca", "db"), ("met", "observed_ok")),
        ({"A": "ac", "B": "bd"}, ("ca", "b", "d"), ("met", "observed_ok")),
        ({"A": "ac", "B": "bd"}, ("ca", "d", "b"), ("missed", "observed_missed")),
        # c runs before b, in another group than it should.
        ({"A": "ac", "B": "bd"}, ("a", "bcd"), ("met", "observed_ok")),
        ({"A": "ac", "B": "bd"}, ("ab", "cd"), ("missed", "observed_missed")),
    ],
)
def test_groups_of_several_runnables(bodies, groups, expected):
    assert answers(bodies, groups, **every(10, B=5)) == {"A, B": expected}


def test_a_task_that_the_first_one_triggers():
    """b is triggered after a, or before it: then A, of the higher priority, still ends a before b starts, but not on other cores."""
    trigger = Trigger(stimulus="go B")
    for body, cores, observed in (
        (["a", trigger], {}, "observed_ok"),
        ([trigger, "a"], {}, "observed_ok"),
        ([trigger, "a"], {"B": "c1"}, "observed_missed"),
    ):
        found = answers({"A": body, "B": ["b"]}, A_THEN_B, periods={"A": 10}, cores=cores)
        assert found == {"A, B": ("unknown", observed)}


@pytest.mark.parametrize(
    ("bodies", "more", "reason"),
    [
        ({"A": ["a"], "B": ["b"]}, {"periods": {"A": 10, "B": 20}}, "not activated equally often"),
        ({"A": ["a", "b"], "B": ["b"]}, every(10), "several positions"),
        ({"A": ["a"], "B": [SOMETIMES_B]}, every(10), "exactly once"),
        ({"A": ["a"], "B": ["b"]}, {**every(10, B=5), "scope": ("A",)}, "outside of the scope"),
    ],
)  # fmt: skip
def test_where_it_is_unknown_which_executions_belong_together(bodies, more, reason):
    """Neither command says that the order holds, or does not."""
    assert answers(bodies, A_THEN_B, **more) == {"": ("unknown", "not_observed")}
    scope = more.pop("scope", ())
    called = {
        process: [Call(runnable=each) if isinstance(each, str) else each for each in body] for process, body in bodies.items()
    }
    order = OrderConstraint(name="O", groups=A_THEN_B, processes=scope)
    model = system(called, runnables={"a": [ticks(1)], "b": [ticks(1)]}, orders=(order,), **more)
    for found in (analyze_system(model), simulated(model)):
        assert reason in found.requirements[0].reason


def test_each_process_that_calls_all_of_them_is_judged_alone():
    found = answers({"A": ["a", "b"], "B": ["b", "a"]}, A_THEN_B, **every(10))
    assert found == {"A": ("met", "observed_ok"), "B": ("missed", "observed_missed")}
    assert answers({"A": ["a", "b"], "B": ["b", "a"]}, A_THEN_B, scope=("A",), **every(10)) == {"A": ("met", "observed_ok")}


def test_a_runnable_that_no_process_calls_is_missing_in_each_job():
    assert answers({"A": ["a"], "B": ["c"]}, (("a",), ("d",)), **every(10)) == {"A": ("missed", "observed_missed")}


def test_calls_in_groups_count_as_others():
    ordered = Group(activities=(Call(runnable="a"), Call(runnable="b")))
    assert answers({"A": [ordered], "B": ["d"]}, A_THEN_B, **every(10)) == {"A": ("met", "observed_ok")}
    free = Group(activities=ordered.activities, ordered=False)
    assert answers({"A": [free], "B": ["d"]}, A_THEN_B, **every(10)) == {"A": ("unknown", "observed_missed")}


def test_a_second_call_in_a_branch_is_not_overlooked():
    """Half of the jobs execute a once more, after b."""
    branches = (Chance(weight=1, activities=(Call(runnable="a"),)), Chance(weight=1, activities=()))
    found = answers({"A": ["a", "b", ProbabilitySwitch(branches=branches)], "B": ["d"]}, A_THEN_B, **every(10))
    assert found == {"A": ("unknown", "observed_missed")}


@pytest.mark.parametrize("first", ["a", "outer"])
def test_a_runnable_that_another_one_calls_is_not_overlooked(first):
    """The job executes b after a, within another runnable, or before it."""
    order = OrderConstraint(name="O", groups=A_THEN_B)
    then = "outer" if first == "a" else "a"
    runnables = {"a": [ticks(1)], "b": [ticks(1)], "outer": [Call(runnable="b"), ticks(1)]}
    model = system(
        {"A": [Call(runnable=first), Call(runnable=then)], "B": []}, runnables=runnables, orders=(order,), **every(10)
    )
    (proved,), (observed,) = analyze_system(model).requirements, simulated(model).requirements
    assert (str(proved.verdict), str(observed.verdict)) == ("unknown", "not_observed")
    assert observed.reason.startswith("'b' is called by the runnable 'outer'")
