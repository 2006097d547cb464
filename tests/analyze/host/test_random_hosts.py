"""Random hosts against schedules that are made tick by tick: no response time and no latency exceeds its bound."""

from random import Random

import pytest
from effort import every
from opponent.hunt_hosts import hunt
from played_groups import Executor
from played_groups import play as play_groups
from played_host import Thread, play
from random_hosts import KINDS, arrivals, multi_threaded_system_of, phases, random_groups, random_threads, system_of

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.host import RosRelease


def check(analysis, paths, own, whole):
    """No time from a release, and none from that of the first callback of a chain, exceeds its bound."""
    responses = {handle.name: handle for executor in analysis.host for handle in executor.handles}
    for name, time in own.items():
        worst = responses[name].response.worst
        assert worst is None or time <= worst, name
    for name in (path[-1] for path in paths):
        bound = analysis.chains[name].worst_if_not_lost
        assert responses[name].lost or bound is None or whole[name] <= bound, name


@pytest.mark.parametrize(("kind", "seed"), every(8, [(kind, seed) for kind in KINDS for seed in range(120)]))
def test_no_schedule_exceeds_a_bound(kind, seed):
    random = Random(f"{kind} {seed}")
    threads, sources, paths = random_threads(random, kind)
    analysis = analyze_system(system_of(threads, sources, paths))
    for _ in range(4):
        fresh = [Thread(each.kind, each.priority, each.callbacks) for each in threads]
        for thread in fresh:
            thread.due = phases(random, thread.callbacks)
        outside = {topic: arrivals(random, *rule, 1500) for topic, rule in sources.items()}
        check(analysis, paths, *play(fresh, outside, 1500, random))


@pytest.mark.parametrize("seed", every(16, range(240)))
def test_no_schedule_of_several_threads_exceeds_a_bound(seed):
    random = Random(f"groups {seed}")
    callbacks, groups, sources, paths, threads = random_groups(random)
    release = random.choice([RosRelease.HUMBLE, RosRelease.JAZZY])
    analysis = analyze_system(multi_threaded_system_of(callbacks, groups, sources, paths, threads, release))
    for _ in range(4):
        executor = Executor(callbacks, groups, threads, release is RosRelease.JAZZY, phases(random, callbacks))
        outside = {topic: arrivals(random, *rule, 1500) for topic, rule in sources.items()}
        check(analysis, paths, *play_groups(executor, outside, 1500, random))


@pytest.mark.parametrize("seed", every(12, [seed for seed in range(9 * 30) if seed % 9 > 6]))
def test_nothing_exceeds_a_bound_with_all_kinds_and_policies_together(seed):
    """Threads of several policies on several cores, with services, variables, shared topics and short queues."""
    found = hunt(seed)
    assert found.rules.startswith("all together")
    assert not found.false


def test_most_bounds_are_known():
    """Otherwise the tests above say nothing."""
    known = total = 0
    for seed in range(40):
        threads, sources, paths = random_threads(Random(f"single {seed}"), "single")
        for executor in analyze_system(system_of(threads, sources, paths)).host:
            total += len(executor.handles)
            known += sum(handle.response.worst is not None for handle in executor.handles)
    assert known > 0.8 * total
    together = [hunt(seed) for seed in (7, 8, 16, 17, 25, 26)]
    assert sum(len(each.ratios) for each in together) > 0.5 * sum(each.total for each in together)
