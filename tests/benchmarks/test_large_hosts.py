"""Hosts with hundreds of callbacks: the analysis takes as many steps for each of them, whatever their number is."""

import pytest
from hosts import CHAINS, large_host

from amalthea_uros.analyze.response_times.task import Supply
from amalthea_uros.analyze.system import analyze_system


@pytest.fixture
def demands(monkeypatch):
    """Counts the times for demands that are looked up: each is a step of a fixed point."""
    counted, time_for = [0], Supply.time_for

    def counting(supply, demand):
        counted[0] += 1
        return time_for(supply, demand)

    monkeypatch.setattr(Supply, "time_for", counting)
    return counted


def test_twice_the_callbacks_take_about_twice_the_steps(demands):
    """8 executors on 4 cores; each step asks all callbacks of an executor, so that the time grows as a square, but no faster."""
    counts = []
    for callbacks in (100, 200):
        demands[0] = 0
        chains = analyze_system(large_host(callbacks)).chains
        assert [chain.name for chain in chains if chain.worst is None] == []
        assert len(chains) == CHAINS
        counts.append(demands[0])
    small, large = counts
    assert 0 < large < 3 * small
