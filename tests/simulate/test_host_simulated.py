"""Executors of the host in simulations: by hand, against a player that knows nothing of the product, and against bounds."""

from random import Random

import pytest
from effort import every
from played_host import Thread, play
from random_hosts import KINDS, random_threads, system_of

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.runs.run import simulate_system


class Fixed:
    """Always the first possibility."""

    def sample(self, items, _count):
        return list(items)

    def choice(self, items):
        return items[0]

    def randint(self, first, _last):
        return first


def observed(system, duration, **options):
    """The callbacks of the simulated host by name."""
    found = simulate_system(system, Options(duration=duration, **options))
    assert not found.errors
    return {handle.name: handle for executor in found.host for handle in executor.handles}


SEEDS = every(4, [(kind, seed) for kind in KINDS for seed in range(120)])


@pytest.mark.parametrize(("kind", "seed"), SEEDS)
def test_a_simulation_is_the_schedule_of_the_player(kind, seed):
    """With the longest execution times, no jitter, and callbacks of a kind in the order of registration."""
    threads, sources, paths = random_threads(Random(f"{kind} {seed}"), kind)
    sources = {topic: (period, 0) for topic, (period, _) in sources.items()}
    found = observed(system_of(threads, sources, paths), 1501, mode=SimulationMode.WORST)
    fresh = [Thread(each.kind, each.priority, each.callbacks) for each in threads]
    for thread in fresh:
        thread.due = {each.name: each.period for each in thread.callbacks if each.period}
    own, _ = play(fresh, {topic: range(0, 1501, period) for topic, (period, _) in sources.items()}, 1500, Fixed())
    assert {name: handle.response_time.max for name, handle in found.items() if handle.calls} == own


@pytest.mark.parametrize(("kind", "seed"), SEEDS)
def test_nothing_that_is_simulated_exceeds_a_bound(kind, seed):
    threads, sources, paths = random_threads(Random(f"{kind} {seed}"), kind)
    system = system_of(threads, sources, paths)
    bounds = {handle.name: handle.response.worst for executor in analyze_system(system).host for handle in executor.handles}
    for name, handle in observed(system, 5000, seed=seed).items():
        assert bounds[name] is None or not handle.calls or handle.response_time.max <= bounds[name], name
