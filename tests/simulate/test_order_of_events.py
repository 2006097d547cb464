"""Who goes first where several things happen at one instant, or somebody comes back from waiting; schedules worked out by hand."""

from opponent.simulation import record
from opponent.to_perf import MICROSECOND, to_perf

from amalthea_uros.simulate.options import Options


def task(name, body, period, priority=1, offset=0, preemption="preemptive", **more):
    process = {"name": name, "kind": "task", "core": "core0", "priority": priority, "preemption": preemption}
    return {**process, "arrival": {"periodic": {"period": period, "offset": offset}}, "body": body, **more}


def execute(time):
    return {"execute": [time, time]}


def jobs(*processes, duration, policy="FPP", semaphores=None, runnables=None):
    system = {"cores": {"core0": policy}, "processes": list(processes), "runnables": runnables or {}}
    system["semaphores"] = {name: {"ceiling": has_ceiling} for name, has_ceiling in (semaphores or {}).items()}
    found = record(to_perf(system), Options(duration=duration * MICROSECOND))
    return {p["name"]: [tuple(t // MICROSECOND for t in job) for job in found.jobs_of(p["name"])] for p in processes}


def test_equals_go_in_the_order_of_their_activations():
    # The second job of `twice` is activated at 5, before `once` at 7, although it cannot begin before the first one has ended.
    high = task("high", [execute(4)], 100, priority=2)
    twice = task("twice", [execute(6)], 5)
    once = task("once", [execute(1)], 100, offset=7)
    found = jobs(high, twice, once, duration=18)
    assert found["twice"][:2] == [(0, 4, 10), (5, 10, 16)]
    assert found["once"] == [(7, 16, 17)]


def test_a_job_ends_with_its_last_group_although_somebody_has_waited_for_the_group_to_end():
    low = task("low", [{"group": [execute(4)], "interruptible": False}], 100)
    high = task("high", [execute(2)], 100, priority=2, offset=1)
    assert jobs(low, high, duration=20) == {"low": [(0, 0, 4)], "high": [(1, 4, 6)]}


def test_a_group_does_not_keep_off_who_arrives_at_the_instant_at_which_it_would_begin():
    low = task("low", [execute(1), {"group": [execute(4)], "interruptible": False}], 100)
    high = task("high", [execute(2)], 100, priority=2, offset=1)
    assert jobs(low, high, duration=20) == {"low": [(0, 0, 7)], "high": [(1, 1, 3)]}


def test_a_ceiling_is_a_deadline_where_deadlines_decide():
    # The holder gets the deadline of the other user at most: who has an earlier one, and does not use it, goes first.
    holder = task("holder", [{"request": "s"}, execute(5), {"release": "s"}], 100, deadline=90)
    user = task("user", [{"request": "s"}, execute(1), {"release": "s"}], 100, deadline=50, offset=60)
    other = task("other", [execute(1)], 100, deadline=10, offset=2)
    found = jobs(holder, user, other, duration=59, policy="EDF", semaphores={"s": True})
    assert found == {"holder": [(0, 0, 6)], "user": [], "other": [(2, 2, 3)]}


def test_who_comes_back_from_waiting_keeps_nobody_off_before_it_has_its_core():
    # While `first` waits, `last` goes on from its schedule point; its release makes `first` ready, which it does not keep off.
    last = task(
        "last",
        [{"request": "s"}, execute(2), {"point": True}, execute(1), {"release": "s"}, execute(1)],
        100,
        preemption="cooperative",
    )
    first = task("first", [{"request": "s"}, execute(1), {"release": "s"}], 100, 2, 1, "cooperative")
    found = jobs(last, first, duration=50, semaphores={"s": False})
    assert found == {"last": [(0, 0, 4)], "first": [(1, 2, 5)]}


def test_only_a_call_that_takes_place_lets_others_go_first():
    call = {"call": "r", "prescaler": 2, "offset": 0}
    low = task("low", [execute(2), call, execute(2)], 20, preemption="cooperative")
    high = task("high", [execute(1)], 100, 2, 1, "cooperative")
    # The first occurrence of the call is skipped.
    assert jobs(low, high, duration=20, runnables={"r": [execute(1)]})["high"] == [(1, 4, 5)]


def test_who_has_used_up_its_slice_ends_if_nothing_is_left():
    a, b = task("a", [execute(2)], 100, slice=2), task("b", [execute(2)], 100, slice=2)
    assert jobs(a, b, duration=20, policy="RR") == {"a": [(0, 0, 2)], "b": [(0, 2, 4)]}


def test_a_job_ends_with_its_last_release_although_somebody_more_urgent_has_waited_for_it():
    low = task("low", [{"request": "s"}, execute(3), {"release": "s"}], 100)
    high = task("high", [{"request": "s"}, execute(2), {"release": "s"}], 100, priority=2, offset=1)
    assert jobs(low, high, duration=20, semaphores={"s": False}) == {"low": [(0, 0, 3)], "high": [(1, 1, 5)]}
