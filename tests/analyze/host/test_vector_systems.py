"""Whole systems of the vectors: no bound is below a worst case of their player, and executors that no method covers are unknown."""

from collections import defaultdict
from statistics import median

import pytest
from host_vectors import entries, every_entry, host_of, paths, with_chains
from support import ROOT

from amalthea_uros.analyze.system import analyze_system

#: Methods of the vectors that are used: no bound is above theirs where they hold.
USED = {
    *("ecrts19-polled", "ecrts19-prefix", "ecrts19-chain", "rtss21-rr", "rtss21-rr-unordered", "rtss21-bw"),
    *("fifo", "polled-under-fp", "rtss22-e2e", "rtss22-jiang"),
}
#: The others, and where they are said to be on the page.
NOT_USED = {
    "ecrts19-timer": "timers before all others",
    "np-fp": "the order within a kind",
}


@pytest.mark.skipif(not list(entries()), reason="the vectors are not at hand")
def test_every_method_of_the_vectors_is_used_or_the_page_says_why_not():
    methods = {method for entry in every_entry() for method in entry["bounds"]}
    assert methods == USED | NOT_USED.keys()
    page = (ROOT / "docs" / "ros2-host.md").read_text()
    assert [words for words in NOT_USED.values() if words not in page] == []


@pytest.mark.parametrize("entry", [pytest.param(entry, id=entry["system"]["name"]) for entry in entries()])
def test_no_bound_is_below_an_observed_value_or_above_a_published_one(entry):
    system, observed = entry["system"], entry["observed"]
    analysis = analyze_system(with_chains(host_of(system), paths(system).items()))
    handles = {handle.name: handle for executor in analysis.host for handle in executor.handles}
    for callback in system["callbacks"]:
        name, worst = callback["name"], handles[callback["name"]].response.worst
        # A callback that is missing starves.
        assert worst is None or worst >= observed[name]["response"], name
        if entry["lost"].get(name) and worst is not None:
            assert handles[name].lost is not None
    for name, path in paths(system).items():
        if len(path) > 1 and (bound := analysis.chains[name].worst_if_not_lost) is not None:
            assert bound >= observed[name]["latency"], name
    for method in USED.intersection(name for name, verdict in entry["holds"].items() if verdict == "holds"):
        for name, published in entry["bounds"][method].items():
            bound = handles[name].response.worst if name in handles else analysis.chains[name].worst_if_not_lost
            assert bound is not None, (method, name)
            assert bound <= published, (method, name)


@pytest.mark.skipif(not list(entries()), reason="the vectors are not at hand")
def test_groups_that_can_starve_are_unknown():
    (system,) = (entry["system"] for entry in entries() if entry["system"]["name"] == "fact-starvation-of-a-group")
    (result,) = analyze_system(with_chains(host_of(system), [])).host
    assert all(handle.response.worst is None for handle in result.handles)
    assert "starve" in result.reason


def ratios(entry):
    """The bounds divided by the largest observed values: of callbacks, and of chains of at least two; only those that are known."""
    system, observed = entry["system"], entry["observed"]
    analysis = analyze_system(with_chains(host_of(system), paths(system).items()))
    for executor in analysis.host:
        for handle in executor.handles:
            if handle.response.worst is not None and handle.name in observed:
                yield "callbacks", handle.response.worst / observed[handle.name]["response"]
    for name, path in paths(system).items():
        bound = analysis.chains[name].worst_if_not_lost
        if len(path) > 1 and bound is not None:
            yield "chains", bound / observed[name]["latency"]


def kind(system):
    """The row of the table of the page."""
    first, *others = system["executors"]
    if others:
        return "several threads of fixed priority"
    if "reservation" in first:
        return "single-threaded in a reservation"
    return {"single": "single-threaded", "multi": "multi-threaded"}.get(first["type"], first["type"])


@pytest.mark.skipif(not list(entries()), reason="the vectors are not at hand")
def test_the_pessimism_that_the_page_states():
    found = defaultdict(lambda: defaultdict(list))
    for entry in entries():
        for what, ratio in ratios(entry):
            found[kind(entry["system"])][what].append(ratio)
    page = (ROOT / "docs" / "ros2-host.md").read_text()
    for row, values in found.items():
        cells = [
            f"{median(values[what]):.2f} ({max(values[what]):.1f})" if values[what] else "-" for what in ("callbacks", "chains")
        ]
        assert f"| {row} | {' | '.join(cells)} |" in page
