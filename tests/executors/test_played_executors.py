"""Nothing that a player of the rules of rclc and of its middleware sees contradicts the analysis of executors."""

from dataclasses import replace
from random import Random

import pytest
from effort import IS_THOROUGH
from looping_executors import MS, US, evaluate, guard, looping, message, timer
from played_executors import Spans, play
from random_executors import application, violations

from amalthea_uros.perf.executors import LoopKind, ThreadLoop

#: Applications, each of which is played with several draws of execution times, phases and arrivals.
APPLICATIONS, PLAYS = (6000, 3) if IS_THOROUGH else (100, 2)
PARTS = 10
HORIZON = 300 * MS


@pytest.mark.parametrize("part", range(PARTS))
def test_no_bound_is_exceeded_and_no_loss_is_untold(part):
    for seed in range(part, APPLICATIONS, PARTS):
        played = application(Random(seed))
        results = played.results()
        for number in range(PLAYS):
            assert not violations(played.play(Random(1000 * seed + number), HORIZON), results), seed


def seen(system, costs):
    """What is seen of the handles of the first executor, which the player executes with constant times in microseconds."""
    executor = system.executors[0]
    times = {handle.runnable: (cost * US, cost * US) for handle, cost in zip(executor.handles, costs, strict=True)}
    spans = Spans(costs=times, spins={executor.name: (0, 0)}, sending={}, draw=lambda least, most: most)
    (played,) = play((executor,), spans, 1000 * MS, start=0)
    return [entity.seen for entity in played.entities]


def test_the_player_keeps_the_grid_of_a_timer_and_loses_the_periods_that_passed():
    # Rounds begin every 25 ms. The timer is due at 0, 10, 20 ...; calls at 0, 25 (for 10), 50 (for 30), 75 (for 60): nobody is called
    # for 20; 40 and 50; 70.
    system = looping(timer("t", 10_000, phase=0), loop=ThreadLoop(kind=LoopKind.SLEEPING, timeout=0, sleep=25 * MS))
    (found,) = seen(system, [0])
    assert found.lateness[:4] == [0, 15 * MS, 20 * MS, 15 * MS]
    assert found.lost[:3] == [1, 2, 1]


def test_the_player_takes_one_message_per_round():
    # Two messages at 0: the second one waits for the sleep of 10 ms, and for the callback of the first one.
    system = looping(
        message("a", 100_000, phase=0),
        message("b", 100_000, phase=0),
        loop=ThreadLoop(kind=LoopKind.SLEEPING, timeout=MS, sleep=10 * MS),
    )
    first, second = seen(system, [1000, 500])
    assert (first.responses[0], second.responses[0]) == (1 * MS, 11 * MS + 500 * US)


def test_the_player_wakes_a_millisecond_early_for_a_timer():
    # The wait of 2.5 ms lasts 2 ms; the timer is seen after the sleep of 10 ms, 9.5 ms late.
    system = looping(
        timer("t", 100_000, phase=2500 * US),
        message("a", 10_000_000, phase=9000 * MS),
        loop=ThreadLoop(kind=LoopKind.SLEEPING, timeout=100 * MS, sleep=10 * MS),
    )
    assert seen(system, [0, 0])[0].lateness[0] == 9500 * US


def test_a_wait_can_be_followed_by_preemption_in_each_cycle():
    """The wait for stored messages is a part of the window: what preempts the thread when it ends is not that of before it."""
    played = application(Random(1840))
    assert not violations(played.play(Random(184_000), 400 * MS), played.results())


def test_triggers_of_a_guard_condition_come_closer_by_their_jitter():
    # Every 50 ms, up to 30 ms late: 20 ms apart. Rounds begin every 25 ms.
    loop = ThreadLoop(kind=LoopKind.SLEEPING, timeout=0, sleep=25 * MS)
    lost = evaluate(looping(guard("g", 50_000, jitter=30 * MS), loop=loop)).handles["g"].lost
    assert lost is not None
    assert lost.most == 1
    assert evaluate(looping(guard("g", 50_000, jitter=20 * MS), loop=loop)).handles["g"].lost is None


def test_triggers_that_come_at_an_unknown_rate_can_be_lost():
    lost = evaluate(looping(guard("g"))).handles["g"].lost
    assert lost is not None
    assert lost.most is None
    assert "its rate is not specified" in lost.sequence


def test_executors_share_the_slots_of_their_process():
    """The other executor keeps its message for the whole round, in which no slot is left for one of the first."""
    system = looping(message("a", 100_000, depth=10))
    (executor,) = system.executors
    assert evaluate(system).handles["a"].lost is None
    handles = tuple(replace(executor.handles[0], name=name) for name in ("b", "c"))
    slots = replace(executor.waiting, slots=2)
    executors = (replace(executor, waiting=slots), replace(executor, name="Other", handles=handles, waiting=slots))
    lost = evaluate(replace(system, executors=executors)).handles["a"].lost
    assert lost is not None
    assert lost.is_of_pool
    assert not lost.is_replaced


@pytest.mark.parametrize(
    ("loop", "is_certain"),
    [
        (ThreadLoop(kind=LoopKind.SLEEPING, timeout=0, sleep=51 * MS), True),
        (ThreadLoop(kind=LoopKind.SLEEPING, timeout=0, sleep=60 * MS, sleep_early=10 * MS), False),
        (ThreadLoop(kind=LoopKind.SLEEPING, timeout=0, sleep=60 * MS, sleep_early=10 * MS, pace=60 * MS), True),
        (ThreadLoop(kind=LoopKind.PERIODIC, timeout=0, period=51 * MS), True),
        (ThreadLoop(kind=LoopKind.PERIODIC, timeout=0, period=49 * MS), False),
    ],
)
def test_a_timer_that_expires_more_often_than_rounds_begin_loses_periods_for_certain(loop, is_certain):
    lost = evaluate(looping(timer("t", 50_000), loop=loop)).handles["t"].lost
    assert (lost is not None and lost.is_certain) is is_certain
