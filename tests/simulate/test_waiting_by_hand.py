"""Events of the operating system, and calls of servers: schedules derived by hand."""

import pytest
from by_hand import built, play
from hand_made_systems import Proc, ticks

from amalthea_uros.perf.activities import Call, ClearEvent, ServerCall, ServerCallKind, SetEvent, WaitEvent, Waiting
from amalthea_uros.perf.software import OsEvent, Runnable
from amalthea_uros.timing.observed.job_times import JobColumn

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
