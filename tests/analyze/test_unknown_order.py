"""Tasks without priorities or deadlines: bounds that hold for any order, compared with all orders one by one.

All tasks run at 1 MHz, so that a tick takes 1 us.
"""

from dataclasses import replace
from itertools import permutations, product

import pytest
from effort import examples
from hand_made_systems import Proc, system, ticks
from hypothesis import given
from hypothesis import strategies as st
from support import SHARED
from unit_player import UnitTask, longest_responses

import amalthea_uros as amuros
from amalthea_uros.analyze.explanations.processes import explain_process
from amalthea_uros.analyze.priorities.assignment import propose_priorities
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.os import Parameter, Policy, Scheduler
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US

NO_PRIORITY = SHARED / "vectors" / "verdicts" / "no-priority.amxmi"


def analysed(tasks, priorities, offsets=None, policy=Policy.OSEK):
    """Tasks of (period, demand, whether they can be preempted), by the names T0, T1 and so on."""
    names = [f"T{index}" for index in range(len(tasks))]
    offsets = offsets or [0] * len(tasks)
    tasks = [
        Proc(
            name,
            (ticks(demand),),
            period,
            offset,
            priority=priority,
            task={"preemption": Preemption.PREEMPTIVE if is_preemptive else Preemption.NON_PREEMPTIVE, "activation_limit": 100},
        )
        for name, (period, demand, is_preemptive), priority, offset in zip(names, tasks, priorities, offsets, strict=True)
    ]
    return analyze_system(system(*tasks, schedulers=[Scheduler(name="s0", policy=policy, cores=("c0",))]))


def worst(analysis):
    return [None if each.response is None else each.response.worst for each in analysis.processes]


def test_each_task_can_be_the_lowest():
    # 33.34 ms / 100 and 22.23 ms / 100, at most one of each until both have ended.
    analysis = amuros.analyze(amuros.load(NO_PRIORITY))
    assert [(each.response.worst // 100_000, each.verdict) for each in analysis.processes] == [(5557, "met"), (5557, "met")]
    assert [each.response.best // 100_000 for each in analysis.processes] == [3334, 2223]
    assert {each.response.claim for each in analysis.processes} == {Claim.BOUND}
    assert any("any order of priorities" in sentence for sentence in analysis.assumptions)


def test_an_order_that_matters_is_left_open():
    # 6 us of 8 us, and 3 us of 20 us: as the lowest, the first needs 6 + 3, the second 3 + 2 * 6, and so on.
    first, second = analysed([(8, 6, True), (20, 3, True)], [None, None]).processes
    assert (first.verdict, first.reason) == ("unknown", "it has no priority; as the lowest it needs up to 9 us")
    assert (second.verdict, second.response.worst) == ("met", 15 * US)


def test_an_overload_is_of_no_certain_task():
    found = analysed([(10, 6, True), (10, 6, True)], [None, None]).processes
    assert [each.verdict for each in found] == ["unknown", "unknown"]
    assert found["T0"].reason.startswith("it has no priority; as the lowest, it has no bound")


def test_a_task_longer_than_its_period_misses_it_in_any_order():
    assert analysed([(100, 101, True), (1000, 1, True)], [None, None]).processes["T0"].verdict != "met"


def test_a_known_priority_beside_an_unknown_one():
    # Whether the other one is above or below is not known.
    assert worst(analysed([(10, 2, True), (20, 5, True)], [5, None])) == [7 * US, 7 * US]


def test_the_order_of_the_stated_priorities_is_kept():
    # 1 us of 10 us above 2 us of 20 us; 5 us of 40 us can be above both, or below both, or between them.
    high, low, unknown = analysed([(10, 1, True), (20, 2, True), (40, 5, True)], [3, 1, None]).processes
    assert [each.response.worst // US for each in (high, low, unknown)] == [1 + 5, 2 + 1 + 5, 5 + 1 + 2]


def test_an_explanation_names_what_can_be_above():
    analysis = analysed([(10, 1, True), (20, 2, True), (40, 25, True)], [3, 1, None])
    high, unknown = explain_process(analysis, "T0"), explain_process(analysis, "T2")
    assert [(share.name, share.time) for share in high.shares] == [("T2", 25 * US)]
    # Loads are named where a deadline is not met for certain: 1 + 25 us of 10 us, but 25 + 4 + 2 * 2 us of 40 us.
    assert {load.name for load in high.loads} == {"T0", "T2"}
    assert unknown.loads == ()


def test_what_has_no_bound_in_the_worst_order_is_told_to_state_it():
    (origin,) = explain_process(analysed([(10, 6, True), (10, 6, True)], [None, None]), "T0").origins
    assert origin.remedy == "State the priority of each task of its scheduler."


def test_a_task_that_misses_its_deadline_in_some_order_only_says_so():
    # As the lowest of two it would need 6 us; below the one without a priority, 6 + 3.
    first, _, _ = analysed([(8, 6, True), (80, 3, True), (80, 3, True)], [5, None, 1]).processes
    assert (first.verdict, first.reason) == (
        "unknown",
        "a task of its scheduler has no priority; in the worst order it needs up to 9 us",
    )


def test_deadlines_that_the_scheduler_knows_keep_their_order():
    tasks = [Proc("A", (ticks(1),), 10, deadline=10), Proc("B", (ticks(2),), 20, deadline=20), Proc("C", (ticks(5),), 40)]
    scheduler = Scheduler(name="s0", policy=Policy.DEADLINE_MONOTONIC, cores=("c0",))
    assert worst(analyze_system(system(*tasks, schedulers=[scheduler]))) == [6 * US, 8 * US, 8 * US]


def test_unknown_activations_do_not_delay_what_is_above_them_in_any_order():
    tasks = [Proc("A", (ticks(1),), 10, priority=3), Proc("B", (ticks(1),), priority=1), Proc("C", (ticks(5),), 40)]
    high, low, unknown = analyze_system(system(*tasks)).processes
    assert high.response.worst == 6 * US
    assert (low.response, unknown.response) == (None, None)
    assert unknown.reason == "it has no priority; depends on 'B', which could not be analysed"


@pytest.mark.parametrize(
    ("groups", "longest"),
    [
        # At the ceiling of its group, the task of priority 1 does not let that of priority 2 go first.
        ({"Low": 7, "High": 7}, 3 + 4),
        ({"Low": 7, "Unknown": 7}, 3 + 4 + 6),
        # A group of one changes nothing.
        ({"Low": 7}, 3 + 6),
    ],
)
def test_a_task_of_a_group_counts_at_the_ceiling_of_its_group(groups, longest):
    tasks = [("Middle", 3, 2), ("Low", 4, 1)]
    tasks += [("High", 1, 3)] if "High" in groups else []
    tasks += [("Unknown", 6, None)]
    found = system(*(Proc(name, (ticks(demand),), 100, priority=priority) for name, demand, priority in tasks))
    allocations = [
        replace(each, parameters=(Parameter(name="taskGroup", values=(groups.get(each.task, 0),)),))
        for each in found.mapping.tasks
    ]
    analysis = analyze_system(replace(found, mapping=replace(found.mapping, tasks=tuple(allocations))))
    others = 1 + 6 if "High" in groups else 0
    assert analysis["Middle"].response.worst == (longest + others) * US


def test_nothing_is_simulated_in_an_order_that_is_not_stated():
    result = amuros.simulate(amuros.load(NO_PRIORITY), duration="100 ms")
    assert [finding.message for finding in result.findings if finding.rule == "SIM001"] == [
        "'A' is not simulated: it has no priority",
        "'B' is not simulated: it has no priority",
    ]


@pytest.mark.parametrize("policy", [Policy.EARLIEST_DEADLINE_FIRST, Policy.DEADLINE_MONOTONIC])
def test_deadlines_that_the_scheduler_does_not_know_leave_the_order_open(policy):
    # 6 us of 8 us, and 3 us of 20 us, as above.
    first, second = analysed([(8, 6, True), (20, 3, True)], [None, None], policy=policy).processes
    assert (first.verdict, first.reason) == (
        "unknown",
        "no deadline is stated for its scheduler; as the lowest it needs up to 9 us",
    )
    assert (second.verdict, second.response.worst) == ("met", 15 * US)


@pytest.mark.parametrize("policy", [Policy.EARLIEST_DEADLINE_FIRST])
def test_a_policy_without_priorities_needs_none(policy):
    pairs = amuros.taskset([(5, 1), (10, 1)], unit="ms", policy="EDF")
    assert amuros.analyze(pairs).summary.schedulable == "yes"


TASKS = st.lists(
    st.tuples(st.sampled_from([4, 5, 6, 8, 10, 12]), st.integers(1, 3), st.booleans()), min_size=2, max_size=3
).filter(lambda tasks: sum(demand / period for period, demand, _ in tasks) <= 1)


@examples(20)
@given(TASKS, st.data())
def test_no_order_exceeds_the_bound(tasks, data):
    offsets = [data.draw(st.integers(0, period - 1)) for period, _, _ in tasks]
    bounds = worst(analysed(tasks, [None] * len(tasks), offsets))
    for order in permutations(range(len(tasks))):
        for found, bound in zip(played(tasks, order, offsets), bounds, strict=True):
            assert bound is None or found * US <= bound
        for found, bound in zip(analysed(tasks, order, offsets).processes, bounds, strict=True):
            # Bounds of a known order need not be tight.
            assert bound is None or found.response.claim is not Claim.EXACT or found.response.worst <= bound


@examples(10)
@given(TASKS, st.data())
def test_no_place_of_those_without_priority_exceeds_the_bound(tasks, data):
    offsets = [data.draw(st.integers(0, period - 1)) for period, _, _ in tasks]
    stated = [data.draw(st.sampled_from([1, 3, None])) for _ in tasks]
    if None in stated:
        bounds = worst(analysed(tasks, stated, offsets))
        for order in places(stated):
            for found, bound in zip(played(tasks, order, offsets), bounds, strict=True):
                assert bound is None or found * US <= bound


def places(stated):
    """The priorities 1 and 3 with those that are not stated: above, below, between, and the same."""
    return product(*(range(5) if each is None else (each,) for each in stated))


@examples(10)
@given(TASKS, st.data())
def test_no_deadlines_exceed_the_bound(tasks, data):
    offsets = [data.draw(st.integers(0, period - 1)) for period, _, _ in tasks]
    bounds = worst(analysed(tasks, [None] * len(tasks), offsets, Policy.EARLIEST_DEADLINE_FIRST))
    for deadlines in product([1, 4, 11], repeat=len(tasks)):
        for found, bound in zip(played(tasks, [0] * len(tasks), offsets, deadlines), bounds, strict=True):
            assert bound is None or found * US <= bound


def played(tasks, priorities, offsets, deadlines=(0, 0, 0, 0)):
    """The longest response times of two hyperperiods; the highest priority is served first."""
    rows = [
        UnitTask(period, demand, offset, rank=-priority, is_preemptive=is_preemptive, deadline=deadline)
        for (period, demand, is_preemptive), priority, offset, deadline in zip(
            tasks, priorities, offsets, deadlines, strict=False
        )
    ]
    return longest_responses(rows, 2 * 120 + max(offsets))


def test_priorities_are_proposed_where_there_are_none():
    # Only the first one as the highest meets both: 6 us of 8 us, and then 15 us of 20 us.
    (found,) = propose_priorities(analysed([(8, 6, True), (20, 3, True)], [None, None]))
    assert (found.outcome, found.priorities) == ("proposed", {"T0": 2, "T1": 1})


def test_priorities_do_not_help_where_deadlines_are_missing():
    (found,) = propose_priorities(analysed([(8, 6, True), (20, 3, True)], [None, None], policy=Policy.EARLIEST_DEADLINE_FIRST))
    assert (found.outcome, found.reason) == ("excluded", "'T0': no deadline is stated for its scheduler")
