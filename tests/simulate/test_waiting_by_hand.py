"""Events of the operating system, calls of servers, semaphores and labels: schedules and latencies derived by hand."""

import pytest
from by_hand import built, play
from hand_made_systems import READ, WRITE, Proc, access, chain, locked, release, request, ticks

from amalthea_uros.perf.activities import (
    Call,
    ClearEvent,
    Communication,
    ServerCall,
    ServerCallKind,
    SetEvent,
    WaitEvent,
    Waiting,
)
from amalthea_uros.perf.events import ProcessChange, ProcessEvent
from amalthea_uros.perf.os import Semaphore, SemaphoreKind
from amalthea_uros.perf.software import Label, OsEvent, Runnable
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.observed.job_times import JobColumn
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration

A_AND_B = (OsEvent(name="a"), OsEvent(name="b"))


def sets(name, event, at, process=None):
    """A task on the other core that sets an event once."""
    return Proc(name, (SetEvent(events=(event,), process=process), ticks(1)), 1000, at, priority=1, scheduler="s1")


@pytest.mark.parametrize(("all_of_them", "end"), [(False, 6), (True, 10)])
def test_who_waits_for_any_event_goes_on_with_the_first_one_and_who_waits_for_all_with_the_last_one(all_of_them, end):
    # Runs 0..1, waits; a is set at 5, b at 9; executes one tick more.
    body = (ticks(1), WaitEvent(events=("a", "b"), all_of_them=all_of_them), ticks(1))
    found = play(built(Proc("T", body, 1000, priority=1), sets("A", "a", 5), sets("B", "b", 9), os_events=A_AND_B), 100)
    assert found["T"] == [(0, 0, end)]


def test_an_event_is_set_for_one_process_or_for_all():
    # At 5 `first` alone gets the event, at 9 everybody.
    waits = (WaitEvent(events=("a",)), ticks(1))
    first = Proc("first", waits, 1000, priority=2)
    then = Proc("then", waits, 1000, priority=1)
    found = play(built(first, then, sets("one", "a", 5, "first"), sets("all", "a", 9), os_events=A_AND_B), 100)
    assert (found["first"], found["then"]) == ([(0, 0, 6)], [(0, 0, 10)])


def test_waiting_does_not_clear_an_event_but_clearing_does():
    # Job 0 waits until 5. Job 1 of `keeps` finds the event of job 0 at 20; that of `clears` waits until it is set again at 105.
    keeps = Proc("keeps", (WaitEvent(events=("a",)), ticks(1)), 20, priority=2)
    clears = Proc("clears", (WaitEvent(events=("a",)), ClearEvent(events=("a",)), ticks(1)), 20, priority=1)
    setter = Proc("setter", (SetEvent(events=("a",)), ticks(1)), 100, 5, priority=1, scheduler="s1")
    found = play(built(keeps, clears, setter, os_events=A_AND_B), 130)
    assert found["keeps"][:3] == [(0, 0, 6), (20, 20, 21), (40, 40, 41)]
    # `clears` follows `keeps` at 5, and has to wait for it at 20 before it starts. Its activations at 40, 60, 80 and 100 are lost.
    assert found["clears"] == [(0, 0, 7), (20, 21, 106)]
    assert found.column("clears", JobColumn.INSTANCE) == [0, 1]


def test_one_process_clears_its_own_events_only():
    # Both get the event at 5; `clears` at once clears its own. `late` finds its own still set at 20.
    clears = Proc("clears", (WaitEvent(events=("a",)), ClearEvent(events=("a",)), ticks(1)), 1000, priority=2)
    late = Proc("late", (WaitEvent(events=("a",)), ticks(1)), 1000, 20, priority=1)
    found = play(built(clears, late, sets("setter", "a", 5), os_events=A_AND_B), 100)
    assert found["late"] == [(20, 20, 21)]


@pytest.mark.parametrize(
    ("waiting", "low", "polling", "waited"), [(Waiting.ACTIVE, (0, 7, 10), 5, 0), (Waiting.PASSIVE, (0, 1, 4), 0, 5)]
)
def test_who_polls_keeps_its_core_and_who_waits_gives_it_away(waiting, low, polling, waited):
    # `high` executes 0..1, waits until 6, executes 6..7; `low` needs 3: after `high`, or while it waits.
    body = (ticks(1), WaitEvent(events=("a",), waiting=waiting), ticks(1))
    high, rest = Proc("high", body, 1000, priority=2), Proc("low", (ticks(3),), 1000, priority=1)
    found = play(built(high, rest, sets("setter", "a", 6), os_events=A_AND_B), 100)
    assert found["high"] == [(0, 0, 7)]
    assert found["low"] == [low]
    assert (found.times("high", JobColumn.POLLING), found.times("high", JobColumn.WAITING)) == ([polling], [waited])


def call(kind=ServerCallKind.SYNCHRONOUS, runnable="serve", **more):
    return ServerCall(runnable=runnable, kind=kind, **more)


ASYNCHRONOUS, GET_RESULT = ServerCallKind.ASYNCHRONOUS, ServerCallKind.GET_RESULT
SERVE = Runnable(name="serve", activities=(ticks(3),))
OTHER = Runnable(name="other", activities=(ticks(2),))


def test_a_server_on_the_same_core_answers_when_the_client_waits_passively():
    # The client asks at 2 and waits; the server starts at 7, answers at 10; the client executes 10..11, before the server goes on.
    client = Proc("client", (ticks(2), call(waiting=Waiting.PASSIVE), ticks(1)), 1000, priority=2)
    server = Proc("server", (Call(runnable="serve"), ticks(4)), 1000, 7, priority=1)
    found = play(built(client, server, runnables=(SERVE,)), 100)
    assert (found["client"], found["server"]) == ([(0, 0, 11)], [(7, 7, 15)])


def test_a_request_during_an_execution_is_answered_by_the_next_one():
    # The server executes 0..3 and 20..23: it was asked at 1, in its first execution.
    client = Proc("client", (ticks(1), call(), ticks(1)), 1000, priority=1)
    server = Proc("server", (Call(runnable="serve"),), 20, priority=1, scheduler="s1")
    found = play(built(client, server, runnables=(SERVE,)), 100)
    assert found["client"] == [(0, 0, 24)]
    assert found.times("client", JobColumn.POLLING) == [22]


def test_an_asynchronous_call_does_not_wait_and_its_result_is_fetched_later():
    # Asked at 1; the server answers at 13. `early` fetches at 4, waits until 13; `late` finds the answer at 16.
    early, late = (
        Proc(
            name,
            (ticks(1), call(ASYNCHRONOUS), ticks(length), call(GET_RESULT), ticks(1)),
            1000,
            priority=1,
            scheduler=scheduler,
        )
        for name, length, scheduler in (("early", 3, "s0"), ("late", 15, "s1"))
    )
    server = Proc("server", (Call(runnable="serve"),), 1000, 10, priority=2)
    found = play(built(early, late, server, runnables=(SERVE,)), 100)
    assert (found["early"], found["late"]) == ([(0, 0, 14)], [(0, 0, 17)])
    # `early` polls 4..10; then the server preempts it.
    assert (found.times("early", JobColumn.POLLING), found.times("early", JobColumn.PARKING)) == ([6], [3])


@pytest.mark.parametrize("calls_between", [1, 3])
def test_a_call_of_another_server_in_between_does_not_change_which_result_is_fetched(calls_between):
    # On the other core, `serve` executes 20..23 and 40..43; `other` executes 2..4, 6..8 and so on.
    between = (call(runnable="other"),) * calls_between
    client = Proc("client", (call(), call(ASYNCHRONOUS), *between, call(GET_RESULT), ticks(1)), 1000, priority=1)
    slow = Proc("slow", (Call(runnable="serve"),), 20, 20, priority=1, scheduler="s1")
    fast = Proc("fast", (Call(runnable="other"),), 4, 2, priority=2)
    found = play(built(client, slow, fast, runnables=(SERVE, OTHER)), 200)
    # The client asks at 0, again at 24 after `fast`, gets the answers of `other` by 36, and that of 43 after `fast` at 44.
    assert found["client"] == [(0, 0, 45)]


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


EVENTS = (
    ProcessEvent(name="begin", process="producer", change=ProcessChange.START),
    ProcessEvent(name="end", process="consumer", change=ProcessChange.TERMINATE),
)


@pytest.mark.parametrize(
    ("communication", "expected"),
    [
        # The consumer reads at 13 and 33; the producer has written at 11 and 31: the responses at 14 and 34 show 10 and 30.
        (
            Communication.EXPLICIT,
            {
                "reduced_data_age": (4, 4),
                "data_age": (24, 24),  # 34 - 10
                "reduced_reaction_time": (4, 14),  # 14 - 10, and 34 - 20
                "reaction_time": (14, 24),  # 14 - 0, and 34 - 10
                "last_to_first": (4, 4),
                "first_to_last": (24, 24),
            },
        ),
        # It reads at its start at 11 and 31; the jobs of 0 and 20 have ended at 7 and 27: 14 and 34 show 0 and 20.
        (
            Communication.IMPLICIT,
            {
                "reduced_data_age": (14, 14),
                "data_age": (34, 34),  # 34 - 0
                "reduced_reaction_time": (14, 24),  # 14 - 0, and 34 - 10
                "reaction_time": (24, 34),  # 34 - 10, and 34 - 0
                "last_to_first": (14, 14),
                "first_to_last": (34, 34),
            },
        ),
        # It reads at its activation at 25 and 45; at 20 and 40 the values of 10 and 30 have been published: 34 and 54 show these.
        (
            Communication.LET,
            {
                "reduced_data_age": (24, 24),
                "data_age": (44, 44),  # 54 - 10
                "reduced_reaction_time": (24, 34),  # 34 - 10, and 34 - 0
                "reaction_time": (34, 44),  # 34 - 0, and 54 - 10
                "last_to_first": (24, 24),
                "first_to_last": (44, 44),
            },
        ),
    ],
)
def test_latencies_from_the_start_of_a_producer_to_the_end_of_a_consumer(communication, expected):
    # The producer starts at 0, 10, ..., writes after 1, ends after 7. The consumer is activated at 5, 25, ..., starts at 11, 31, ...
    # when the more urgent task on its core has ended, reads after 2 and ends after 3.
    producer = Proc("producer", (ticks(1), access("data", WRITE, communication), ticks(6)), 10, priority=1)
    rival = Proc("rival", (ticks(6),), 20, 5, priority=2, scheduler="s1")
    consumer = Proc("consumer", (ticks(2), access("data", READ, communication), ticks(1)), 20, 5, priority=1, scheduler="s1")
    parts = {"labels": (Label(name="data"),), "events": EVENTS, "chains": (chain("through", "begin", "end"),)}
    run = simulate_system(built(producer, rival, consumer, **parts), Options(duration=Duration(400 * US)))
    found = {quantity.value: latency for quantity, latency in run.chains["through"].quantities.items()}
    assert {name: (found[name].min / US, found[name].max / US) for name in expected} == expected
