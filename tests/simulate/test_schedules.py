"""Published schedules are simulated job by job; other people's simulations found them."""

import json

import pytest
from by_hand import play
from hand_made_systems import Proc, system, ticks
from support import SHARED

SCHEDULES = SHARED / "vectors" / "schedules.json"
CASES = json.loads(SCHEDULES.read_text())["cases"] if SCHEDULES.exists() else []


@pytest.mark.skipif(not CASES, reason="the vectors are not at hand")
@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_every_job_starts_and_ends_as_published(case):
    """A unit of time of a vector is a microsecond here; 0 is its highest priority."""
    limit, until = {"activation_limit": 99}, case["simulated_until"]
    processes = [
        Proc(t["name"], (ticks(t["wcet"]),), t["period"], t["offset"], priority=1000 - t["priority"], task=limit)
        for t in case["tasks"]
    ]
    # The last jobs of a vector end after the time up to which jobs are released.
    last = max(end for jobs in case["jobs"].values() for _, _, end in jobs)
    found = play(system(*processes), max(until, last) + 1)
    for name, jobs in case["jobs"].items():
        assert [job for job in found[name] if job[0] < until] == [tuple(job) for job in jobs]
