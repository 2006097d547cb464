"""Random hosts against schedules that are made tick by tick: no response time and no latency exceeds its bound."""

from random import Random

import pytest
from effort import every
from played_host import Thread, play
from random_hosts import KINDS, random_threads, system_of

from amalthea_uros.analyze.system import analyze_system


def arrivals(random, period, jitter, horizon):
    """Messages that come with a jitter; often all of it at first and then none, so that they come close to each other."""
    phase, style = random.randrange(period), random.random()
    times = []
    for nominal in range(phase, horizon, period):
        late = jitter if nominal < horizon // 2 and style < 0.5 else 0
        times.append(nominal + (late if style < 0.5 else random.randint(0, jitter)))
    return sorted(times)


@pytest.mark.parametrize(("kind", "seed"), every(4, [(kind, seed) for kind in KINDS for seed in range(120)]))
def test_no_schedule_exceeds_a_bound(kind, seed):
    random = Random(f"{kind} {seed}")
    threads, sources, paths = random_threads(random, kind)
    analysis = analyze_system(system_of(threads, sources, paths))
    responses = {handle.name: handle for executor in analysis.host for handle in executor.handles}
    latencies = {path[-1]: analysis.chains[path[-1]].worst_if_not_lost for path in paths}
    for _ in range(4):
        fresh = [Thread(each.kind, each.priority, each.callbacks) for each in threads]
        for thread in fresh:
            thread.due = {each.name: random.randrange(each.period) for each in thread.callbacks if each.period}
        outside = {topic: arrivals(random, *rule, 1500) for topic, rule in sources.items()}
        own, whole = play(fresh, outside, 1500, random)
        for name, time in own.items():
            worst = responses[name].response.worst
            assert worst is None or time <= worst, name
        for name, bound in latencies.items():
            if responses[name].lost is None:
                assert bound is None or whole[name] <= bound, name


def test_most_bounds_are_known():
    """Otherwise the test above says nothing."""
    known = total = 0
    for seed in range(40):
        threads, sources, paths = random_threads(Random(f"single {seed}"), "single")
        for executor in analyze_system(system_of(threads, sources, paths)).host:
            total += len(executor.handles)
            known += sum(handle.response.worst is not None for handle in executor.handles)
    assert known > 0.8 * total
