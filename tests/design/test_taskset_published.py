"""Task sets with response times and latencies that other programs and papers give, made by `taskset` alone.

The oracles: published examples that were derived again; pyCPA and response-time-analysis-rs for random task sets; the end-to-end
analyses of TU Dortmund (2021) for chains. Times in nanoseconds, priority 0 is the highest.
"""

import json

import pytest
from support import SHARED

import amalthea_uros as amuros

NS = 1000
FOLDER = SHARED / "vectors"
LATENCIES = {
    "mrt": amuros.LatencyQuantity.MAX_REACTION_TIME,
    "mda": amuros.LatencyQuantity.MAX_DATA_AGE,
    "mrda": amuros.LatencyQuantity.MAX_REDUCED_DATA_AGE,
    "mrrt": amuros.LatencyQuantity.MAX_REDUCED_REACTION_TIME,
}


def cases(file, count=None):
    """Cases of a file, evenly chosen."""
    path = FOLDER / file
    found = json.loads(path.read_text())["cases"] if path.exists() else []
    chosen = found[:: max(1, len(found) // count)] if count else found
    return [pytest.param(case, id=case["id"]) for case in chosen]


pytestmark = pytest.mark.skipif(not FOLDER.exists(), reason="the vectors are not at hand")


def tasks(case):
    def task(each):
        known = {key: each[key] for key in ("period", "wcet", "deadline", "jitter", "offset", "bcet") if key in each}
        return {"name": each["name"], "priority": -each["priority"]} | known

    return [task(each) for each in case["tasks"]]


def preemptive(found):
    return [each for each in found if each.values[0]["scheduling"] == "fixed_priority_preemptive"]


@pytest.mark.parametrize("case", preemptive(cases("textbook.json")) + preemptive(cases("rta_random.json")))
def test_response_times(case):
    analysis = amuros.analyze(amuros.taskset(tasks(case), unit="ns"))
    assert [process.wcrt for process in analysis.processes] == [time * NS for time in case["expected_wcrt"]]


@pytest.mark.parametrize("case", [each for each in cases("chains.json", 40) if "exact" in each.values[0]])
def test_latencies_of_known_schedules(case):
    # Execution times are constant, and all releases are known.
    system = amuros.taskset(tasks(case), chains={"chain": case["chain"]}, unit="ns")
    found = amuros.analyze(system).chains["chain"]
    for name, latency in case["exact"].items():
        assert (found.value(LATENCIES[name]).value, found.value(LATENCIES[name]).claim) == (latency * NS, "exact")
