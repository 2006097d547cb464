"""Optimal priorities and sensitivity, against trying everything."""

from fractions import Fraction
from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT
from test_system import system, ticks

from amalthea_uros import describe
from amalthea_uros.analyze.assignment import assign, propose_priorities
from amalthea_uros.analyze.response_times import priority_levels
from amalthea_uros.analyze.response_times.task import Task as AnalysedTask
from amalthea_uros.analyze.sensitivity import max_scale, sensitivity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.timing.event_models import Periodic as PeriodicEvents
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.timing.settings import Settings
from amalthea_uros.units import MICROSECOND as US

ROWS = st.lists(st.tuples(st.integers(4, 14), st.integers(0, 8), st.integers(1, 4), st.integers(2, 16)), min_size=1, max_size=4)


def meets(order, tasks, deadlines):
    """Whether an order of indices, lowest priority first, meets all deadlines."""
    ranked = [AnalysedTask(name=t.name, events=t.events, demand=t.demand, priority=order.index(i)) for i, t in enumerate(tasks)]
    responses = priority_levels.response_times(ranked)
    return all(r.worst is not None and r.worst <= d for r, d in zip(responses, deadlines, strict=True))


@given(ROWS)
def test_there_is_an_assignment_if_and_only_if_one_of_all_orders_is_one(rows):
    tasks = [
        AnalysedTask(name=str(index), events=PeriodicEvents(period, jitter), demand=MultiframeDemand.constant(wcet))
        for index, (period, jitter, wcet, _) in enumerate(rows)
    ]
    deadlines = [deadline for *_, deadline in rows]
    found = assign(tasks, deadlines)
    some = any(meets(list(order), tasks, deadlines) for order in permutations(range(len(tasks))))
    assert (found is not None) == some
    if found is not None:
        assert meets(found, tasks, deadlines)


def test_deadline_monotonic_order_is_not_best_with_jitter():
    # The task with the shorter deadline arrives regularly; only below the jittering one both fit.
    tasks = [
        AnalysedTask(name="regular", events=PeriodicEvents(20), demand=MultiframeDemand.constant(4)),
        AnalysedTask(name="jittering", events=PeriodicEvents(20, 16), demand=MultiframeDemand.constant(3)),
    ]
    assert assign(tasks, [10, 10]) is not None


@pytest.mark.parametrize("sample", ["bodas-test-advanced", "drive-and-lift"])
def test_the_maximum_scale_is_where_a_verdict_changes(sample):
    described = describe(ROOT / "samples" / f"{sample}.yaml").system
    scale = max_scale(analyze_system(described))
    assert analyze_system(described, Settings(scale=scale)).summary.schedulable == "yes"
    slower = Settings(scale=scale * Fraction(1001, 1000) + Fraction(1, 1000))
    assert analyze_system(described, slower).summary.schedulable != "yes"


def test_the_control_function_of_the_thesis_has_room_for_its_deadline():
    # 29 us may become 1 ms; then the executor and the control function take 25 and 4 of every 29 parts.
    described = describe(ROOT / "samples" / "bodas-test-advanced.yaml").system
    assert float(max_scale(analyze_system(described))) == pytest.approx(1000 / 29, rel=1e-3)


def tasks_on_a_core(*rows, **more):
    """Periodic tasks of (name, period, ticks, deadline), all at 1 MHz, with the first one at the lowest priority."""
    return system(
        ["core"],
        [
            Periodic(name=f"every {name}", period=period * US, offset=index * US)
            for index, (name, period, _, _) in enumerate(rows)
        ],
        [Task(name=name, stimuli=(f"every {name}",), activities=(ticks(wcet),)) for name, _, wcet, _ in rows],
        [
            TaskAllocation(task=name, scheduler="core", priority=index, deadline=deadline * US if deadline else None)
            for index, (name, _, _, deadline) in enumerate(rows)
        ],
        frequency=10**6,
        **more,
    )


def test_sensitivity_of_single_processes():
    built = tasks_on_a_core(("low", 100, 20, 100), ("high", 100, 10, 30))
    found = sensitivity(analyze_system(built))
    # The higher one has three times what it needs; the lower one has what is left of 100.
    assert float(found.everything) == pytest.approx(3, rel=1e-3)
    assert float(found.processes["low"]) == pytest.approx((100 - 10) / 20, rel=1e-3)
    assert float(found.processes["high"]) == pytest.approx(3, rel=1e-3)


def test_the_largest_factor_of_an_application_with_chains_is_the_last_one_that_holds():
    built = describe(ROOT / "samples" / "drive-and-lift.yaml").system
    factor = max_scale(analyze_system(built))
    assert analyze_system(built, Settings(scale=factor)).summary.schedulable == "yes"
    assert analyze_system(built, Settings(scale=factor * Fraction(101, 100))).summary.schedulable != "yes"


def test_what_is_missed_is_met_again_with_less():
    found = sensitivity(analyze_system(tasks_on_a_core(("low", 100, 20, 15), ("high", 100, 10, 30))))
    # The lower one takes 20 alone, whatever the higher one does.
    assert (found.everything, found.processes) == (Fraction(1, 2), {"low": Fraction(1, 4), "high": None})


def test_priorities_are_proposed_in_the_order_that_fits():
    built = tasks_on_a_core(("urgent", 100, 10, 12), ("slow", 400, 60, 200), ("middle", 200, 30, 50))
    (proposal,) = propose_priorities(analyze_system(built))
    assert proposal.current == {"urgent": 0, "slow": 1, "middle": 2}
    assert proposal.priorities == {"urgent": 2, "slow": 0, "middle": 1}


@pytest.mark.parametrize(
    ("rows", "reason"),
    [
        ([("A", 100, 10, None)], "'A' has no deadline"),
        ([("A", 100, 60, 100), ("B", 100, 60, 100)], "no assignment of priorities meets all deadlines"),
    ],
)
def test_reasons_without_a_proposal(rows, reason):
    (proposal,) = propose_priorities(analyze_system(tasks_on_a_core(*rows)))
    assert (proposal.priorities, proposal.reason) == (None, reason)
