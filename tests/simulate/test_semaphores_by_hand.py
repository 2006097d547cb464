"""Semaphores: schedules derived by hand."""

from by_hand import built, play
from hand_made_systems import Proc, locked, release, request, ticks

from amalthea_uros.perf.activities import Waiting
from amalthea_uros.perf.os import Semaphore, SemaphoreKind
from amalthea_uros.timing.observed.job_times import JobColumn


def test_two_users_at_a_time():
    # `a` and `b` hold it from 0; `c` comes at 2 and waits until `b` releases it at 6, then it preempts `a`.
    a = Proc("a", locked("s", 10), 1000, priority=1)
    b = Proc("b", locked("s", 6), 1000, priority=1, scheduler="s1")
    c = Proc("c", locked("s", 2), 1000, 2, priority=2)
    found = play(built(a, b, c, semaphores=(Semaphore(name="s", users=2),)), 100)
    assert (found["a"], found["b"], found["c"]) == ([(0, 0, 12)], [(0, 0, 6)], [(2, 2, 8)])
    assert found.times("c", JobColumn.WAITING) == [4]


def test_exclusive_use_waits_until_nobody_else_holds_it_and_keeps_everybody_off():
    # `a` holds it 0..4, `b` 1..6; `alone` waits from 2 to 6 and holds it until 9; `late` waits from 7 to 9.
    a = Proc("a", locked("s", 4), 1000, priority=1)
    b = Proc("b", (ticks(1), *locked("s", 5)), 1000, priority=1, scheduler="s1")
    alone = Proc("alone", locked("s", 3, exclusive=True), 1000, 2, priority=2)
    late = Proc("late", locked("s", 1), 1000, 7, priority=2, scheduler="s1")
    found = play(built(a, b, alone, late, semaphores=(Semaphore(name="s", users=3),)), 100)
    assert (found["a"], found["b"], found["alone"], found["late"]) == ([(0, 0, 4)], [(0, 0, 6)], [(2, 2, 9)], [(7, 7, 10)])


def test_initial_users_hold_it_for_ever():
    # One of two places is taken: `b` waits for `a` although there are two.
    a = Proc("a", locked("s", 4), 1000, priority=1)
    b = Proc("b", (ticks(1), *locked("s", 1)), 1000, priority=1, scheduler="s1")
    found = play(built(a, b, semaphores=(Semaphore(name="s", users=2, initial_users=1),)), 100)
    assert (found["a"], found["b"]) == ([(0, 0, 4)], [(0, 0, 5)])


def test_without_ownership_others_than_the_holder_release_it():
    # The semaphore is taken at first; `signals` releases it at 5, so that `waits` gets it, and at 25 for the second job.
    waits = Proc("waits", (ticks(1), request("s"), ticks(1)), 20, priority=2)
    signals = Proc("signals", (ticks(1), release("s")), 20, 4, priority=1)
    found = play(built(waits, signals, semaphores=(Semaphore(name="s", initial_users=1, ownership=False),)), 40)
    assert found["waits"] == [(0, 0, 6), (20, 20, 26)]


def test_with_ownership_only_the_holder_releases_it():
    holder = Proc("holder", locked("s", 10), 1000, priority=1)
    stranger = Proc("stranger", (ticks(1), release("s")), 1000, 4, priority=2)
    waits = Proc("waits", (request("s"), ticks(1)), 1000, 6, priority=1, scheduler="s1")
    # The stranger preempts the holder for a tick, and changes nothing.
    found = play(built(holder, stranger, waits, semaphores=(Semaphore(name="s"),)), 100)
    assert found["waits"] == [(6, 6, 12)]


def test_the_most_urgent_of_those_that_wait_gets_it_first():
    # `first` waits since 1, `then` since 2: at 10 the more urgent one gets it and executes 10..13, then the other one.
    holder = Proc("holder", locked("s", 10), 1000, priority=1, scheduler="s1")
    first = Proc("first", locked("s", 3), 1000, 1, priority=1)
    then = Proc("then", locked("s", 3), 1000, 2, priority=2)
    found = play(built(holder, first, then, semaphores=(Semaphore(name="s"),)), 100)
    assert (found["first"], found["then"]) == ([(1, 1, 16)], [(2, 2, 13)])


def test_who_polls_for_a_spinlock_keeps_its_core_and_is_parked_while_preempted():
    # `holds` has it 0..10. `polls` asks at 1, is parked 4..6, gets it at 10. `low` executes when `polls` has ended at 12.
    holds = Proc("holds", locked("s", 10), 1000, priority=1, scheduler="s1")
    polls = Proc("polls", (ticks(1), *locked("s", 2)), 1000, priority=2)
    high, low = Proc("high", (ticks(2),), 1000, 4, priority=3), Proc("low", (ticks(1),), 1000, priority=1)
    found = play(built(holds, polls, high, low, semaphores=(Semaphore(name="s", kind=SemaphoreKind.SPINLOCK),)), 100)
    assert (found["polls"], found["high"], found["low"]) == ([(0, 0, 12)], [(4, 4, 6)], [(0, 12, 13)])
    assert (found.times("polls", JobColumn.POLLING), found.times("polls", JobColumn.PARKING)) == ([7], [2])


def test_who_is_parked_gets_a_spinlock_and_is_ready():
    # `polls` is parked from 4 to 14; at 10 it gets the lock and is ready; until 14 `high` has the core.
    holds = Proc("holds", locked("s", 10), 1000, priority=1, scheduler="s1")
    polls = Proc("polls", (ticks(1), *locked("s", 2)), 1000, priority=1)
    high = Proc("high", (ticks(10),), 1000, 4, priority=2)
    late = Proc("late", (request("s", Waiting.ACTIVE), ticks(1), release("s")), 1000, 11, priority=1, scheduler="s1")
    found = play(built(holds, polls, high, late, semaphores=(Semaphore(name="s", kind=SemaphoreKind.SPINLOCK),)), 100)
    assert (found["polls"], found["late"]) == ([(0, 0, 16)], [(11, 11, 17)])
    assert (found.times("polls", JobColumn.POLLING), found.times("polls", JobColumn.PARKING)) == ([3], [6])


def test_a_ceiling_is_the_priority_of_the_most_urgent_user_also_of_one_on_another_core():
    # `low` holds it 0..4 at priority 5: `mid` with 3 waits, `top` with 7 does not. `user` waits on its own core from 2 to 5.
    low = Proc("low", (*locked("s", 4), ticks(2)), 1000, priority=1)
    mid, top = Proc("mid", (ticks(1),), 1000, 1, priority=3), Proc("top", (ticks(1),), 1000, 3, priority=7)
    user = Proc("user", locked("s", 2), 1000, 2, priority=5, scheduler="s1")
    found = play(built(low, mid, top, user, semaphores=(Semaphore(name="s", ceiling=True),)), 100)
    assert (found["low"], found["mid"], found["top"]) == ([(0, 0, 8)], [(1, 5, 6)], [(3, 3, 4)])
    assert found["user"] == [(2, 2, 7)]


def test_nested_sections_have_the_higher_one_of_their_ceilings():
    # `low` holds `outer` (ceiling 2) 0..6 and `inner` (ceiling 4) 2..4: `b` (3) comes at 3 and preempts it at 4, `a` (2) at 6 + 1.
    low = Proc("low", (request("outer"), ticks(2), *locked("inner", 2), ticks(2), release("outer"), ticks(1)), 1000, priority=1)
    a = Proc("a", locked("outer", 1), 1000, 1, priority=2)
    b = Proc("b", (ticks(1),), 1000, 3, priority=3)
    c = Proc("c", locked("inner", 1), 1000, 50, priority=4)
    semaphores = (Semaphore(name="outer", ceiling=True), Semaphore(name="inner", ceiling=True))
    found = play(built(low, a, b, c, semaphores=semaphores), 40)
    assert (found["low"], found["a"], found["b"]) == ([(0, 0, 9)], [(1, 7, 8)], [(3, 4, 5)])
