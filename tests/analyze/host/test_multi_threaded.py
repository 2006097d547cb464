"""Executors of several threads whose callbacks exclude each other in groups: examples computed by hand."""

from dataclasses import replace

import pytest
from random_hosts import Callback, multi_threaded_system_of

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.host import RosRelease


def worst(rules, threads, sends=None):
    """The response times of timers (period, execution time, group), and why there are none; `sends`: who wakes whom."""
    callbacks = [Callback(name, time, time, period) for name, period, time, _ in rules]
    for one, other in (sends or {}).items():
        before, after = (next(each for each in callbacks if each.name == name) for name in (one, other))
        before.sends, after.topic = {other: 0}, other
    groups = {name: group for name, _, _, group in rules}
    (result,) = analyze_system(multi_threaded_system_of(callbacks, groups, {}, [], threads, RosRelease.HUMBLE)).host
    return {handle.name: handle.response.worst for handle in result.handles}, result.reason


def test_a_group_with_a_thread_of_its_own_only_waits_for_its_members():
    """B has just begun when A is due, and the other way round; C is alone. All need more than one core."""
    found, _ = worst([("A", 100, 60, "g"), ("B", 100, 20, "g"), ("C", 100, 70, "h")], 2)
    assert found == {"A": 20 + 60, "B": 60 + 20, "C": 70}


def test_groups_that_share_threads_wait_for_all_at_most():
    """Three groups have two threads; as long as any callback is pending, one of them works."""
    found, _ = worst([("A", 100, 20, "g"), ("B", 100, 10, "g"), ("C", 100, 5, "h"), ("D", 100, 5, "i")], 2)
    assert found == dict.fromkeys("ABCD", 20 + 10 + 5 + 5)


def test_callbacks_of_one_chain_in_a_group_share_the_threads_with_other_chains():
    """While C is pending, both threads execute 20 of A and B, and 2 of E, which ends at the end of its period and then begins again."""
    rules = [("A", 100, 5, "g"), ("B", 0, 15, "g"), ("C", 100, 10, "h"), ("E", 10_000, 1, "i")]
    found, _ = worst(rules, 2, sends={"A": "B"})
    assert found["C"] == (20 + 2) // 2 + 10


@pytest.mark.parametrize(("threads", "is_known"), [(2, False), (3, True)])
def test_members_of_a_group_can_starve_if_there_are_more_groups_than_threads(threads, is_known):
    """The example of H. Teper et al. 2024: D never runs with two threads."""
    rules = [("A", 1000, 500, "a"), ("B", 1000, 500, "b"), ("C", 1000, 400, "g"), ("D", 1000, 10, "g")]
    found, reason = worst(rules, threads)
    assert found["D"] == (410 if is_known else None)
    assert ("starve" in reason) is not is_known


def test_one_thread_waits_for_those_of_higher_priority_on_its_core():
    """A needs 2, and H of the other executor, which takes the core first, 12."""
    system = multi_threaded_system_of([Callback("A", 2, 2, 50)], {"A": "g"}, {}, [], 1, RosRelease.HUMBLE)
    (executor,) = system.host.executors
    (callback,) = multi_threaded_system_of([Callback("H", 12, 12, 60)], {"H": "h"}, {}, [], 1, RosRelease.HUMBLE).host.callbacks
    higher = replace(executor, name="higher", thread=replace(executor.thread, priority=2), callbacks=(callback,))
    low, _ = analyze_system(replace(system, host=replace(system.host, executors=(executor, higher)))).host
    assert low.handles["A"].response.worst == 12 + 2
