"""Whole systems of the vectors: no bound is below a worst case of their player, and executors that no method covers are unknown."""

import pytest
from host_vectors import entries, host_of, linked_chains, with_chains

from amalthea_uros.analyze.system import analyze_system


@pytest.mark.parametrize("entry", [pytest.param(entry, id=entry["system"]["name"]) for entry in entries()])
def test_no_bound_is_below_an_observed_value(entry):
    system, observed = entry["system"], entry["observed"]
    analysis = analyze_system(with_chains(host_of(system), linked_chains(system)))
    handles = {handle.name: handle for executor in analysis.host for handle in executor.handles}
    for callback in system["callbacks"]:
        name, worst = callback["name"], handles[callback["name"]].response.worst
        # A callback that is missing starves.
        assert worst is None or worst >= observed[name]["response"], name
        if entry["lost"].get(name) and worst is not None:
            assert handles[name].lost is not None
    for name, path in linked_chains(system):
        if len(path) > 1 and (bound := analysis.chains[name].worst_if_not_lost) is not None:
            assert bound >= observed[name]["latency"], name


def test_groups_that_exclude_each_other_are_unknown():
    starved = [entry["system"] for entry in entries() if any("group" in each for each in entry["system"]["callbacks"])]
    for system in starved:
        host = host_of(system)
        results = analyze_system(with_chains(host, [])).host
        for executor, result in zip(host.executors, results, strict=True):
            if not all(callback.is_reentrant for callback in executor.callbacks):
                assert all(handle.response.worst is None for handle in result.handles)
                assert "starve" in result.reason
