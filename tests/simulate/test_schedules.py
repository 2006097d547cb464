"""Published schedules are simulated job by job; other people's simulations found them."""

import json

import pytest
from opponent.simulation import record
from support import SHARED

from amalthea_uros.perf.activities import Demand, Execute
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure, StructureKind
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Os, Scheduler
from amalthea_uros.perf.software import Software, Task
from amalthea_uros.perf.stimuli import Periodic, Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Options
from amalthea_uros.units import Frequency

NANOSECOND = 1000
SCHEDULES = SHARED / "vectors" / "schedules.json"
CASES = json.loads(SCHEDULES.read_text())["cases"] if SCHEDULES.exists() else []


def system_of(tasks):
    """Fixed priorities on a core at 1 GHz, where a tick is a nanosecond; 0 is the highest priority of a vector."""
    core = Structure(name="ECU", kind=StructureKind.ECU, cores=(Core(name="core", clock="clock"),))
    scheduler = Scheduler(name="scheduler", policy="FixedPriorityPreemptive", cores=("core",))
    return System(
        hardware=Hardware(clocks=(Clock(name="clock", frequency=Frequency(10**9)),), structures=(core,)),
        os=Os(systems=(OperatingSystem(name="OS", schedulers=(scheduler,)),)),
        stimuli=Stimuli(
            stimuli=tuple(
                Periodic(name=f"every {t['name']}", period=t["period"] * NANOSECOND, offset=t["offset"] * NANOSECOND)
                for t in tasks
            )
        ),
        software=Software(
            tasks=tuple(
                Task(
                    name=t["name"],
                    stimuli=(f"every {t['name']}",),
                    activities=(Execute(demand=Demand(ticks=Constant(t["wcet"]))),),
                    activation_limit=99,
                )
                for t in tasks
            )
        ),
        mapping=Mapping(
            tasks=tuple(TaskAllocation(task=t["name"], scheduler="scheduler", priority=1000 - t["priority"]) for t in tasks)
        ),
    )


@pytest.mark.skipif(not CASES, reason="the vectors are not at hand")
@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_every_job_starts_and_ends_as_published(case):
    until = case["simulated_until"]
    # The last jobs of a vector end after the time up to which jobs are released.
    last = max(end for jobs in case["jobs"].values() for _, _, end in jobs)
    found = record(system_of(case["tasks"]), Options(duration=(max(until, last) + 1) * NANOSECOND))
    for name, jobs in case["jobs"].items():
        simulated = [job for job in found.jobs_of(name) if job[0] < until * NANOSECOND]
        assert simulated == [tuple(time * NANOSECOND for time in job) for job in jobs]
