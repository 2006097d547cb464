"""Executors in loops as people write them; all figures are derived by hand from what rclc and rmw_microxrcedds do."""

from dataclasses import replace
from itertools import product

import pytest
from looping_executors import (
    ARDUINO,
    MS,
    SPIN,
    US,
    Proc,
    TriggerKind,
    WaitBehaviour,
    combined,
    evaluate,
    guard,
    looping,
    message,
    ticks,
    timer,
    waiting_publication,
)

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.executors.semantics.loops import lost_periods, next_expiration, workload
from amalthea_uros.judge.verdict import Failure, Verdict
from amalthea_uros.perf.constraints import Bound, Constraints, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.executors import Executor, HandleKind, LoopKind, Publication, ThreadLoop
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.event_models.models import PeriodicEvents


def rules(model):
    return {finding.rule for finding in analyze_system(model).findings}


def test_a_message_waits_for_the_sleep_and_the_running_round():
    # It arrives just after the wait of a round that calls the other one: 2 ms + 100 ms + its own 1 ms.
    found = evaluate(looping(message("a", 500_000, 1000), message("b", 300_000, 2000)))
    # The other one can arrive at the same time, before it: a round of 2 ms and a sleep more.
    assert found.handles["a"].response.worst == 2 * (2 + 100) * MS + 1 * MS
    assert found.handles["a"].response.best == 1 * MS
    assert found.handles["b"].response.worst == 2 * (2 + 100) * MS + 2 * MS


def test_one_message_per_round_limits_the_loop_of_the_arduino_examples_to_ten_messages_per_second():
    # 11 messages/s arrive, a round with its delay(100) takes at least 100 ms.
    model = looping(message("a", 91_000))
    found = analyze_system(model)
    response = found.executors[0].handles["a"].response
    assert response.worst is None
    assert response.is_overload
    assert "11 messages/s arrive" in response.reason.replace("10.99", "11")
    assert "at most 10 per second" in response.reason
    assert found.processes["Executor"].failure is Failure.OVERLOAD
    assert found.summary.schedulable == "no"
    # After 60 s, 600 are served; the 600th came at 54.6 s.
    overload = next(finding for finding in found.findings if finding.rule == "EXE012")
    assert "after 60 s they are at least 5.4 s old" in overload.message


def test_an_overload_is_certain_whatever_happens_on_the_way():
    # The jitter of the wire is unknown, but 11 messages/s are more than 10 rounds/s.
    model = looping(message("a", 91_000, transmission="in"))
    assert evaluate(model).handles["a"].response.is_overload
    # An unknown jitter alone is none: 9 messages/s.
    assert not evaluate(looping(message("a", 111_000, transmission="in"))).handles["a"].response.is_overload


def test_a_publication_that_waits_lets_a_round_serve_a_message_of_each_handle():
    # 2 times 6 messages/s against 10 rounds/s: while it waits, it reads all messages before its acknowledgement, and stores them.
    publishing = timer("t", 5_000_000, publications=(waiting_publication(timeout=MS),))
    inputs = message("a", 166_000), message("b", 166_000)
    assert all(handle.response.is_overload for handle in evaluate(looping(*inputs)).handles)
    found = analyze_system(looping(*inputs, publishing))
    assert not any(handle.response.is_overload for handle in found.executors[0].handles)
    assert found.processes["Executor"].failure is not Failure.OVERLOAD
    # 22 messages/s are more than a message of each in 10 rounds/s.
    assert evaluate(looping(message("a", 90_000), message("b", 90_000), publishing)).handles["a"].response.is_overload


def test_an_executor_that_serves_everything_is_met():
    found = analyze_system(looping(message("a", 500_000, 1000), timer("t", 500_000, 1000)))
    assert found.processes["Executor"].verdict is Verdict.MET
    assert found.summary.schedulable == "yes"
    assert found.executors[0].handles["a"].lost is None


def test_messages_of_all_topics_share_the_rounds():
    found = evaluate(looping(message("a", 250_000), message("b", 250_000), message("c", 250_000)))
    assert all(handle.response.is_overload for handle in found.handles)


def test_publishing_from_a_timer_is_limited_to_ten_times_per_second():
    # The period of 10 ms is shorter than the sleep: calls are at least 100 ms apart, and 10 periods pass.
    lost = evaluate(looping(timer("t", 10_000))).handles["t"].lost
    assert lost.is_certain
    assert lost.most == 10
    assert "the next call is due at 110 ms" in lost.sequence


def test_a_timer_is_late_by_the_sleep_and_the_round():
    # Checked just before it is due, with the 1 ms of the other callback still to be executed.
    found = evaluate(looping(timer("t", 1_000_000, 500), message("a", 1_000_000, 1000)))
    assert found.handles["t"].lateness == Span(most=(0 + 1 + 100) * MS + 500 * US)
    assert found.handles["t"].response.worst == 102 * MS
    assert found.handles["t"].lost is None
    assert "EXE011" in rules(looping(timer("t", 500_000)))
    assert "EXE011" not in rules(looping(timer("t", 500_000), loop=SPIN))


@pytest.mark.parametrize(("timeout", "loop"), [(1000, 1000), (5, 6)])
def test_a_wait_of_spin_period_uses_the_timeout_and_not_the_period(timeout, loop):
    # Without rclc_executor_set_timeout the timeout is 1 s; with 5 ms the period of 20 ms and the cut of the sleep count.
    period = ThreadLoop(kind=LoopKind.PERIODIC, timeout=timeout * MS, period=20 * MS)
    model = looping(message("a", 100_000), loop=period)
    assert evaluate(model).loop.most == (timeout + 21) * MS
    assert ("EXE020" in rules(model)) is (timeout > 20)


def test_a_guard_condition_is_seen_when_something_else_ends_the_wait():
    # spin without a sleep, timeout 1 s: the round of a, then the whole wait.
    found = evaluate(looping(message("a", 2_000_000, 3000), guard("g", 5_000_000, 1000), loop=SPIN))
    assert found.handles["g"].response.worst == (3 + 1 + 1000 + 3 + 1) * MS
    handles = guard("g", 5_000_000, 1000), message("a", 2_000_000)
    woken = evaluate(looping(*handles, loop=SPIN, waiting=WaitBehaviour(guard_conditions_end_wait=True)))
    assert woken.handles["g"].response.worst == 2 * MS


def test_a_timer_ends_the_wait_one_unit_early_at_most():
    # The timer of 10.5 ms: the wait of at most 10 ms is what a guard condition waits for.
    found = evaluate(looping(timer("t", 10_500), guard("g"), message("a", 9_000_000), loop=SPIN))
    assert found.handles["g"].response.worst == 10 * MS


def test_a_wait_lasts_until_a_timer_is_due_for_the_first_time():
    # Due every 10 ms, but first at 50 ms: until then, nothing ends the wait in which the guard condition is triggered.
    found = evaluate(looping(timer("t", 10_000, phase=50 * MS), guard("g"), message("a", 9_000_000), loop=SPIN))
    assert found.handles["g"].response.worst == 50 * MS
    soon = evaluate(looping(timer("t", 10_000, phase=5 * MS), guard("g"), message("a", 9_000_000), loop=SPIN))
    assert soon.handles["g"].response.worst == 10 * MS


def test_a_publication_that_waits_blocks_the_round_until_its_timeout():
    publishing = message("a", 5_000_000, 1000, publications=(waiting_publication(transmission="odom_out"),))
    model = looping(publishing, timer("t", 3_000_000), loop=SPIN)
    found = evaluate(model)
    assert found.round.most == 1001 * MS
    # Just before the timer is due, the message is taken: 1001 ms; another one can be taken with the timer.
    assert found.handles["t"].lateness == Span(most=2 * 1001 * MS)
    assert found.handles["t"].lost is None
    assert evaluate(model, sending={"odom_out": Span(least=1 * MS, most=4 * MS)}).round.most == 5 * MS
    assert "EXE017" in rules(model)


def test_stored_messages_wait_for_the_next_end_of_a_wait():
    # While a publishes for 10 ms, b arrives and is stored; the wait of 1 s does not end for it.
    publishing = message("a", 9_000_000, publications=(waiting_publication(timeout=10 * MS),))
    found = evaluate(looping(publishing, message("b", 9_000_000), loop=SPIN))
    alone = 10 + 1000 + 10
    assert found.handles["b"].response.worst == (alone + 10 + 1000) * MS
    zenoh = WaitBehaviour(
        messages_per_wait=None, stored_data_ends_wait=True, guard_conditions_end_wait=True, slots=None, resolution=0
    )
    woken = evaluate(looping(publishing, message("b", 9_000_000), loop=SPIN, waiting=zenoh))
    assert woken.handles["b"].response.worst == 20 * MS


def test_messages_are_dropped_when_the_slots_are_used():
    # A publication of 1 s, then a wait of 100 ms, twice: at most two messages of 2 s wait in 2.1 s.
    publishing = timer("t", 5_000_000, publications=(waiting_publication(),))
    model = looping(publishing, message("a", 2_000_000, depth=10, reliable=True), loop=replace(SPIN, timeout=100 * MS))
    assert evaluate(model).handles["a"].lost is None
    few = replace(model, executors=(replace(model.executors[0], waiting=WaitBehaviour(slots=1)),))
    lost = evaluate(few).handles["a"].lost
    assert lost.is_of_pool
    assert "up to 2 messages for all handles of" in lost.sequence
    assert "use its 1 slot;" in lost.sequence
    assert "EXE014" in rules(few)
    assert "EXE015" in rules(looping(publishing, message("a", 2_000_000, depth=1), loop=SPIN))


def test_the_slots_that_are_needed_do_not_depend_on_those_that_there_are():
    def needed(*handles, slots=8, **parts):
        return evaluate(looping(*handles, waiting=WaitBehaviour(slots=slots), **parts)).slots_needed

    # Each wait takes one message, and its round calls it.
    assert needed(message("a", 500_000, depth=10), message("b", 500_000, depth=10)) == 1
    assert needed(timer("t", 500_000)) == 0
    # As above, two of them wait while one is published; without a bound, as many as the history keeps.
    publishing = timer("t", 5_000_000, publications=(waiting_publication(),))
    loop = replace(SPIN, timeout=100 * MS)
    assert {needed(publishing, message("a", 2_000_000, depth=10), loop=loop, slots=slots) for slots in (1, 2, 8)} == {2}
    assert needed(publishing, message("a", None, depth=10), loop=loop) == 10
    assert needed(publishing, message("a", None), loop=loop) is None


def test_each_entity_of_an_action_has_a_history():
    # Three services and a timer of the server, three clients and two subscriptions of the client (rcl_action).
    publishing = timer("t", 5_000_000, publications=(waiting_publication(),))
    handle, cost = message("a", None, depth=10)
    server = replace(handle, kind=HandleKind.ACTION_SERVER, sources=4), cost
    client = replace(handle, kind=HandleKind.ACTION_CLIENT, sources=5), cost
    assert [evaluate(looping(publishing, each)).slots_needed for each in (server, client)] == [30, 50]


def test_an_unknown_interval_makes_all_messages_unknown_but_not_the_timers():
    found = evaluate(looping(message("a", None), message("b", 500_000), timer("t", 500_000, 1000)))
    assert "between two messages for 'a' is not stated" in found.handles["b"].response.reason
    assert found.handles["t"].response.worst == 102 * MS


def test_jitter_on_the_way_that_is_unknown_makes_messages_unknown():
    model = looping(message("a", 500_000, transmission="in"))
    assert "jitter of the messages for 'a'" in evaluate(model).handles["a"].response.reason
    assert evaluate(model, extra_jitter={"a": None}).handles["a"].response.worst is None
    assert evaluate(model, extra_jitter={"a": 0}).handles["a"].response.worst == 100 * MS
    # Two messages can come together, then the second one takes one round more.
    assert evaluate(model, extra_jitter={"a": 500 * MS}).handles["a"].response.worst == 200 * MS


@pytest.mark.parametrize("kind", [TriggerKind.ALL, TriggerKind.CUSTOM])
def test_what_the_trigger_keeps_back_has_no_bound(kind):
    model = looping(message("a", 500_000), timer("t", 500_000), trigger=combined(kind, {"a", "t"}))
    found = evaluate(model)
    assert all("keeps it back" in handle.response.reason for handle in found.handles)
    assert "EXE016" in rules(model)
    assert analyze_system(model).processes["Executor"].verdict is Verdict.UNKNOWN


def test_the_trigger_of_one_handle_does_not_keep_that_one_back():
    found = evaluate(looping(message("a", 500_000), message("b", 500_000), trigger=combined(TriggerKind.ONE, {"a"})))
    assert found.handles["a"].response.worst is not None
    assert found.handles["b"].response.worst is None


def test_higher_priorities_stretch_rounds_and_lower_ones_do_not():
    others = (Proc("high", (ticks(1000),), period=10_000, priority=9), Proc("low", (ticks(5000),), period=50_000, priority=1))
    found = evaluate(looping(message("a", 900_000, 1000), loop=SPIN, others=others))
    # The round before it and its own: each 1 ms and one job of 1 ms.
    assert found.handles["a"].response.worst == 4 * MS


def test_an_executor_that_never_rests_leaves_nothing_for_lower_priorities():
    # Nor for what the operating system itself does below it, such as to feed a watchdog: it is not schedulable for certain.
    model = looping(timer("t", 50_000, 500), loop=SPIN, others=(Proc("low", (ticks(1000),), period=500_000, priority=1),))
    found = analyze_system(model)
    assert found.processes["low"].response is None
    assert found.processes["low"].verdict is found.processes["Executor"].verdict is Verdict.UNKNOWN
    assert "because it has only timers" in found.processes["Executor"].reason
    assert any("because it has only timers" in finding.message for finding in found.findings)
    assert found.summary.schedulable == "unknown"
    # It is called in the next round itself.
    assert found.executors[0].handles["t"].response.worst == 1 * MS


def test_a_loop_that_waits_with_a_timeout_is_busy_while_a_timer_is_kept_back():
    """Before the timer is due, the loop waits; then it turns until a message has come: how much of its core that takes is unknown."""
    model = looping(
        message("a", 500_000, 100), timer("t", 500_000, 100), trigger=combined(TriggerKind.ALL, {"a", "t"}), loop=SPIN
    )
    found = analyze_system(model)
    core = found.processors[found.processes["Executor"].processor]
    assert (core.worst, found.processes["Executor"].verdict) == (1, Verdict.UNKNOWN)
    assert core.at_least == 0
    assert any("kept back by the trigger condition" in finding.message for finding in found.findings)
    assert "EXE016" in rules(model)
    assert "EXE017" not in rules(model)


def test_a_loop_that_waits_with_a_timeout_rests_while_only_messages_are_kept_back():
    # A message that is stored already does not end a wait of this middleware.
    model = looping(
        message("a", 500_000, 100), message("b", 500_000, 100), trigger=combined(TriggerKind.ALL, {"a", "b"}), loop=SPIN
    )
    assert "EXE017" in rules(model)
    assert "EXE016" not in rules(model)


def test_rounds_that_need_not_be_the_longest_are_no_overload():
    # A round of 30 ms every 1 ms at most; it is called every 500 ms.
    low = Proc("low", (ticks(1000),), period=100_000, priority=1)
    model = looping(message("a", 500_000, 30_000), loop=replace(ARDUINO, sleep=1 * MS), others=(low,))
    found = analyze_system(model)
    assert found.processes["low"].verdict is Verdict.UNKNOWN
    assert not found.processors["c0"].is_overloaded
    assert found.summary.schedulable == "unknown"


def test_executors_of_a_session_keep_each_other_from_it():
    model = looping(message("a", 5_000_000), loop=replace(ARDUINO, timeout=300 * MS), session="s")
    executor = model.executors[0]
    handle = replace(executor.handles[0], name="b", publications=(Publication(topic="p"),))
    other = replace(executor, name="Other", handles=(handle,))
    found = evaluate(replace(model, executors=(executor, other)))
    # Other holds it for its wait of 300 ms; a stored message does not end the own wait: (100 + 300) + 300. The message
    # of Other can be before it in the buffer of the session, and the first round reads that one: two rounds.
    assert found.handles["a"].response.worst == 2 * 700 * MS


@pytest.mark.parametrize(("limit", "verdict"), [(101, Verdict.MET), (100, Verdict.UNKNOWN), (0, Verdict.MISSED)])
def test_a_requirement_on_a_callback_is_judged_by_its_handle(limit, verdict):
    model = looping(message("a", 5_000_000, 500))
    requirement = Requirement(
        name="r", runnable="On_a", limit=TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=limit * MS)
    )
    found = analyze_system(replace(model, constraints=Constraints(requirements=(requirement,))))
    assert found.requirements["r"].verdict is verdict


def test_several_handles_of_a_callback_are_one_callback():
    first, second = message("a", 5_000_000, 500), message("b", 5_000_000, 500)
    model = looping(first, second)
    executor = model.executors[0]
    handles = tuple(replace(handle, kind=HandleKind.PARAMETER_SERVICE, runnable="On_a") for handle in executor.handles)
    found = analyze_system(replace(model, executors=(replace(executor, handles=handles),)))
    assert [callback.name for callback in found.callbacks] == ["On_a"]
    # The other one before it.
    assert found.callbacks["On_a"].response.worst == (2 * 100 + 3 * 0.5) * MS


@pytest.mark.parametrize(("sleep", "is_known"), [(0, False), (1, True)])
def test_rounds_that_wait_for_acknowledgements_can_follow_each_other(sleep, is_known):
    # Without a sleep, what became due in the second of the publication is executed at once afterwards.
    publishing = timer("t", 500_000, 1000, publications=(waiting_publication(),))
    loop = ThreadLoop(kind=LoopKind.SLEEPING, timeout=100 * MS, sleep=sleep * MS)
    low = Proc("low", (ticks(1000),), period=100_000, priority=1)
    found = analyze_system(looping(publishing, message("a", 500_000), loop=loop, others=(low,)))
    assert (found.processes["low"].response is not None) is is_known
    alone = analyze_system(looping(publishing, message("a", 500_000), loop=loop))
    assert not any(finding.rule == "ANA005" for finding in alone.findings)


# The demand of rounds that follow each other with a sleep in between, against all rounds of some lengths.


LONGEST = 3


@pytest.mark.parametrize("sleep", [1, 2, 5])
def test_no_rounds_demand_more_than_those_of_the_longest(sleep):
    executor = Executor(name="e", task="t", spin="s", loop=ThreadLoop(kind=LoopKind.SLEEPING, timeout=0, sleep=sleep))
    model = workload(executor, PeriodicEvents(1), LONGEST)
    for lengths in product(range(LONGEST + 1), repeat=5):
        begin, demand = 0, 0
        for length in lengths:
            demand += length
            # The window is just longer than the time at which this round begins.
            assert demand <= LONGEST * model.eta_plus(begin + 1)
            begin += length + sleep


def test_without_a_sleep_it_is_what_begins_rounds():
    executor = Executor(name="e", task="t", spin="s", loop=ThreadLoop(kind=LoopKind.CONTINUOUS, timeout=5))
    assert workload(executor, PeriodicEvents(7), LONGEST) == PeriodicEvents(7)


@pytest.mark.parametrize(("called", "lost", "following"), [(30, 0, 40), (39, 0, 40), (40, 1, 50), (58, 2, 60)])
def test_missed_periods_are_lost_and_the_grid_is_kept(called, lost, following):
    # Due at 30, every 10.
    assert lost_periods(called - 30, 10) == lost
    assert next_expiration(30, called, 10) == following
