"""Optimal priorities and sensitivity, against trying everything."""

from fractions import Fraction
from itertools import permutations
from math import lcm

import pytest
from effort import every, examples
from hand_made_systems import Proc, changed, locked, system, ticks
from hypothesis import example, given
from hypothesis import strategies as st
from support import ROOT, analysis_of
from unit_player import UnitTask, play

from amalthea_uros import describe
from amalthea_uros.analyze.priorities.assignment import ProposalOutcome, propose_priorities
from amalthea_uros.analyze.priorities.orders import lowest_first, with_priorities
from amalthea_uros.analyze.response_times import priority_levels
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.analyze.sensitivity import max_growth, sensitivity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Trigger, WaitEvent
from amalthea_uros.perf.os import Semaphore
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import PeriodicEvents
from amalthea_uros.units import MICROSECOND as US

ROWS = st.lists(st.tuples(st.integers(4, 14), st.integers(0, 8), st.integers(1, 4), st.integers(2, 16)), min_size=1, max_size=3)


def meets(order, tasks, deadlines, of=None):
    """Whether with an order of indices, lowest priority first, all tasks or some of them meet their deadlines."""
    ranked = [AnalysedTask(name=t.name, events=t.events, demand=t.demand, priority=order.index(i)) for i, t in enumerate(tasks)]
    responses = priority_levels.response_times(ranked)
    return all(responses[i].worst is not None and responses[i].worst <= deadlines[i] for i in (order if of is None else of))


def assign(tasks, deadlines):
    """The order that Audsley's algorithm finds by the busy windows of single tasks; None if there is none."""

    names = [task.name for task in tasks]

    def fits(name, order):
        others = [other for other in names if other not in order and other != name]
        return meets([names.index(n) for n in (*order, name, *others)], tasks, deadlines, of=[names.index(name)])

    order, unfitting = next(lowest_first(names, fits))
    return None if unfitting else [names.index(name) for name in order]


@examples(18)
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


@pytest.mark.parametrize("sample", every(3, ["bodas-test-simple", "drive-and-lift", "bodas-test-advanced"]))
def test_the_maximum_factor_is_where_a_verdict_changes(sample):
    described = describe(ROOT / "samples" / f"{sample}.yaml").system
    factor = max_growth(analysis_of(ROOT / "samples" / f"{sample}.yaml"))
    grown = analyze_system(described, Settings(growth=factor * Fraction(1001, 1000) + Fraction(1, 1000)))
    assert grown.summary.schedulable != "yes"
    # Nothing is missed on the way there, also with clocks that are slower by a smaller factor.
    assert analyze_system(described, Settings(growth=factor)).summary.schedulable == "yes"
    for step in every(3, range(6)):
        assert analyze_system(described, Settings(scale=1 + (factor - 1) * step / 5)).summary.schedulable == "yes"
    # The simple one executes 12 us and 4 us every 1 ms, and 2 us every 20 ms; of the advanced one, 29 us may become 1 ms.
    by_hand = {"bodas-test-simple": 1000 / (12 + 4 + 2 / 20), "bodas-test-advanced": 1000 / 29}
    assert float(factor) == pytest.approx(by_hand.get(sample, float(factor)), rel=1e-3)


def tasks_on_a_core(*rows, **parts):
    """Periodic tasks of (name, period, ticks, deadline), all at 1 MHz, with the first one at the lowest priority."""
    tasks = [
        Proc(name, (ticks(wcet),), period, offset=index, priority=index, deadline=deadline)
        for index, (name, period, wcet, deadline) in enumerate(rows)
    ]
    return system(*tasks, **parts)


def test_sensitivity_of_single_processes():
    built = tasks_on_a_core(("low", 100, 20, 100), ("high", 100, 10, 30))
    found = sensitivity(analyze_system(built))
    # The higher one has three times what it needs; the lower one has what is left of 100.
    assert float(found.everything) == pytest.approx(3, rel=1e-3)
    assert float(found.processes["low"]) == pytest.approx((100 - 10) / 20, rel=1e-3)
    assert float(found.processes["high"]) == pytest.approx(3, rel=1e-3)


def test_what_is_missed_is_met_again_with_less():
    found = sensitivity(analyze_system(tasks_on_a_core(("low", 100, 20, 15), ("high", 100, 10, 30))))
    # The lower one takes 20 alone, whatever the higher one does.
    assert (found.everything, found.processes) == (Fraction(1, 2), {"low": Fraction(1, 4), "high": None})


def test_priorities_are_proposed_in_the_order_that_fits():
    built = tasks_on_a_core(("urgent", 100, 10, 12), ("slow", 400, 60, 200), ("middle", 200, 30, 50))
    (proposal,) = propose_priorities(analyze_system(built))
    assert proposal.current == {"urgent": 0, "slow": 1, "middle": 2}
    assert proposal.priorities == {"urgent": 2, "slow": 0, "middle": 1}


def test_an_overload_has_no_proposal():
    (proposal,) = propose_priorities(analyze_system(tasks_on_a_core(("A", 100, 60, 100), ("B", 100, 60, 100))))
    assert (proposal.priorities, proposal.reason) == (None, "with any priorities, the tasks need 120.0 % of the core")


def test_a_task_that_cannot_be_analysed_prevents_a_proposal():
    built = changed(tasks_on_a_core(("A", 100, 60, 100), ("B", 100, 10, 100)), "A", activities=(WaitEvent(events=("E",)),))
    (proposal,) = propose_priorities(analyze_system(built))
    assert proposal.outcome is ProposalOutcome.EXCLUDED
    assert proposal.reason.startswith("'A' could not be analysed: it waits for events")


def player(rows, order, preemptive=True):
    """Whether all jobs of (period, offset, wcet, deadline) meet their deadlines in a simulation, lowest priority first."""
    tasks = [
        UnitTask(period, wcet, offset, rank=-order.index(index), is_preemptive=preemptive)
        for index, (period, offset, wcet, _) in enumerate(rows)
    ]
    end = max(offset for _, offset, *_ in rows) + 3 * lcm(*(period for period, *_ in rows))
    return not any(
        (job.left or job.response > deadline)
        for jobs, (*_, deadline) in zip(play(tasks, end), rows, strict=True)
        for job in jobs
        if job.release + deadline < end
    )


def with_offsets(rows, order, preemption=Preemption.PREEMPTIVE, others=()):
    tasks = [
        Proc(
            f"T{i}", (ticks(wcet),), period, offset, priority=order.index(i), deadline=deadline, task={"preemption": preemption}
        )
        for i, (period, offset, wcet, deadline) in enumerate(rows)
    ]
    return system(*tasks, *others)


@st.composite
def sets_with_offsets(draw):
    rows = []
    for _ in range(draw(st.integers(2, 4))):
        period = draw(st.sampled_from([4, 5, 6, 8, 10, 12]))
        wcet = draw(st.integers(1, 3))
        rows.append((period, draw(st.integers(0, period - 1)), wcet, draw(st.integers(wcet, period))))
    return rows, draw(st.permutations(range(len(rows))))


class TestOffsets:
    """Sets with known releases, against a player that tries all orders."""

    @given(sets_with_offsets())
    # Tasks above lose activations in some orders.
    @example(([(5, 0, 3, 3), (12, 8, 2, 2), (5, 2, 1, 2)], [1, 0, 2]))
    @examples(36)
    def test_a_proposal_if_and_only_if_an_order_meets_all_deadlines(self, drawn):
        rows, present = drawn
        (proposal,) = propose_priorities(analyze_system(with_offsets(rows, present)))
        if proposal.priorities is None:
            assert proposal.outcome is ProposalOutcome.NONE
            assert not any(player(rows, order) for order in permutations(range(len(rows))))
        else:
            found = sorted(range(len(rows)), key=lambda i: proposal.priorities[f"T{i}"])
            assert player(rows, found)
            assert (proposal.outcome is ProposalOutcome.KEPT) == player(rows, present)

    @given(sets_with_offsets())
    def test_with_blocking_a_proposal_holds_and_none_is_true(self, drawn):
        rows, present = drawn
        built = with_offsets(rows, present, Preemption.NON_PREEMPTIVE)
        (proposal,) = propose_priorities(analyze_system(built))
        if proposal.priorities is not None:
            assert player(rows, sorted(range(len(rows)), key=lambda i: proposal.priorities[f"T{i}"]), preemptive=False)
        if proposal.outcome is ProposalOutcome.NONE:
            assert not any(player(rows, order, preemptive=False) for order in permutations(range(len(rows))))

    def test_present_priorities_that_meet_all_deadlines_are_kept(self):
        # Released together, the lower one would take 8; but they are released 5 apart.
        rows = [(10, 0, 4, 4), (10, 5, 4, 4)]
        (proposal,) = propose_priorities(analyze_system(with_offsets(rows, [0, 1])))
        assert (proposal.outcome, proposal.priorities) == (ProposalOutcome.KEPT, {"T0": 0, "T1": 1})

    def test_an_order_that_is_not_deadline_monotonic(self):
        # T1 executes from 2 to 5 and has no time to spare. T0 is released at 4: above T1 it delays that to 6, below it ends at 6.
        rows = [(4, 0, 1, 2), (4, 2, 3, 3)]
        (proposal,) = propose_priorities(analyze_system(with_offsets(rows, [1, 0])))
        assert (proposal.outcome, proposal.priorities) == (ProposalOutcome.PROPOSED, {"T0": 0, "T1": 1})


def test_a_proposal_that_would_spoil_another_core_is_not_made():
    # Busy needs the higher priority for its 35 us. Below it, First ends 10 to 40 us after its activation, so that two jobs of Second,
    # which it triggers, can be only 70 us apart: the later one then takes 2 * 80 - 70 = 90 us.
    built = system(
        Proc("First", (ticks(10), Trigger(stimulus="second")), 100, priority=2, deadline=50),
        Proc("Busy", (ticks(30),), 40, priority=1, deadline=35),
        Proc("Second", (ticks(80),), stimuli=("second",), priority=1, deadline=85, scheduler="s1"),
        triggers=("second",),
    )
    analysis = analyze_system(built)
    assert [str(process.verdict) for process in analysis.processes] == ["met", "missed", "met"]
    on_a, on_b = propose_priorities(analysis)
    assert (on_a.outcome, on_b.outcome) == (ProposalOutcome.NOT_FOUND, ProposalOutcome.KEPT)
    assert on_a.reason == "some priorities meet all deadlines on 'c0', but 'Second' is then no longer met"


def test_tasks_that_share_a_lock_get_priorities_that_hold():
    # Slow holds the lock for 5 us of its 20: above Urgent it delays it by all of them, below only by the 5.
    built = system(
        Proc("Urgent", locked("lock", 5), 100, priority=0, deadline=12),
        Proc("Slow", (*locked("lock", 5), ticks(15)), 100, offset=1, priority=1, deadline=60),
        semaphores=(Semaphore(name="lock", ceiling=True),),
    )
    analysis = analyze_system(built)
    assert analysis.summary.schedulable != "yes"
    (proposal,) = propose_priorities(analysis)
    assert (proposal.outcome, proposal.priorities) == (ProposalOutcome.PROPOSED, {"Urgent": 1, "Slow": 0})
    changed = analyze_system(with_priorities(built, proposal.priorities))
    # Both are released together: Urgent comes first, and Slow has ended before it comes again.
    assert changed["Urgent"].response.worst == 5 * US
    assert changed.summary.schedulable == "yes"


@pytest.mark.parametrize(("deadline", "outcome"), [(10, ProposalOutcome.PROPOSED), (9, ProposalOutcome.NONE)])
def test_priorities_below_an_interrupt(deadline, outcome):
    # The interrupt takes 0 to 5 of each 10. With T1 above T0, they execute from 5 to 7 and 7 to 10; with T0 above T1, T1 ends at 10,
    # 5 after its release.
    interrupt = Proc("Interrupt", (ticks(5),), 10, priority=1, is_isr=True)
    built = with_offsets([(10, 0, 3, deadline), (10, 5, 2, 4)], [1, 0], others=[interrupt])
    (proposal,) = propose_priorities(analyze_system(built))
    assert proposal.outcome is outcome
    assert proposal.priorities == ({"T0": 0, "T1": 1} if outcome is ProposalOutcome.PROPOSED else None)
