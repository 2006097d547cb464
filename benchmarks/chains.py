"""How long event chains take: the schedule of 50 tasks, chains of several lengths through it, and many chains of a whole system.

python benchmarks/chains.py --repeat 5
"""

from __future__ import annotations

import argparse
from fractions import Fraction
from importlib.util import find_spec
from itertools import pairwise
from random import Random

from response_times import least_time

from amalthea_uros.analyze.chains import job_chains
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.analyze.response_times import kernel, schedule
from amalthea_uros.analyze.response_times.schedule import Jobs, PeriodicTask
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf import activities, events, mapping, os, software, stimuli
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.system import System
from amalthea_uros.timing.demand.multiframe import MultiframeDemand

MILLISECOND = 10**9
#: 43,000 jobs in a hyperperiod of 1 s.
PERIODS = (*[1] * 40, *[2] * 5, 5, 10, 20, 100, 1000)
LENGTH = 15


def task_set(random: Random) -> list[PeriodicTask]:
    """50 tasks at 70 % load."""
    shares = [random.random() for _ in PERIODS]
    return [
        PeriodicTask(
            name=f"T{index}",
            period=period * MILLISECOND,
            offset=0,
            demand=MultiframeDemand.constant(max(1, int(period * MILLISECOND * 0.7 * share / sum(shares)))),
            priority=-index,
        )
        for index, (period, share) in enumerate(zip(PERIODS, shares, strict=True))
    ]


def four_quantities(jobs: list[Jobs], chain: list[int], cycle: int) -> tuple[int, int, int, int]:
    """The maxima of a chain."""
    chain_times = [
        ReadWriteTimes(releases=jobs[i].releases, reads=jobs[i].begins, writes=jobs[i].ends, cycle=cycle, until=2 * cycle)
        for i in chain
    ]
    found = job_chains.build_job_chains(chain_times, cycle)
    assert found is not None
    return found.reaction_time, found.data_age, int(found.first_to_first.max()), int(found.last_to_last.max())


def whole_system(tasks: list[PeriodicTask], chains: list[list[int]]) -> System:
    """The tasks as a system, each of which reads what any other one writes, with chains through them."""
    labels = [activities.LabelAccess(label=task.name, kind=activities.AccessKind.READ) for task in tasks]
    made = [
        software.Task(
            name=task.name,
            stimuli=(task.name,),
            activities=(
                *labels,
                activities.Execute(demand=activities.Demand(Constant(task.demand.worst // 1000))),
                activities.LabelAccess(label=task.name, kind=activities.AccessKind.WRITE),
            ),
        )
        for task in tasks
    ]
    ends = [events.ProcessEvent(name=f"{t.name} end", process=t.name, change=events.ProcessChange.TERMINATE) for t in tasks]
    found = []
    for number, chain in enumerate(chains):
        names = [ends[index].name for index in chain]
        items = events.Sequence(tuple(events.Segment(stimulus=a, response=b) for a, b in pairwise(names)))
        found.append(events.EventChain(name=f"C{number}", stimulus=names[0], response=names[-1], items=items))
    scheduler = os.Scheduler(name="scheduler", policy=os.Policy.OSEK, cores=("core",))
    return System(
        hardware=Hardware(
            clocks=(Clock(name="clock", frequency=Fraction(10**9)),),
            structures=(Structure(name="ECU", cores=(Core(name="core", clock="clock"),)),),
        ),
        os=os.Os(systems=(os.OperatingSystem(name="OS", schedulers=(scheduler,)),)),
        stimuli=stimuli.Stimuli(stimuli=tuple(stimuli.Periodic(name=t.name, period=t.period) for t in tasks)),
        software=software.Software(tasks=tuple(made), labels=tuple(software.Label(name=t.name) for t in tasks)),
        mapping=mapping.Mapping(
            tasks=tuple(mapping.TaskAllocation(task=t.name, scheduler="scheduler", priority=t.priority) for t in tasks)
        ),
        events=events.Events(events=tuple(ends), chains=tuple(found)),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    random = Random(12)
    tasks = task_set(random)
    cycle = schedule.hyperperiod(tasks)
    print(f"{len(tasks)} tasks, {sum(cycle // task.period for task in tasks):,} jobs")
    kernel.dispatch.keep_python()
    took = least_time(lambda: schedule.schedule(tasks, cycle, MultiframeDemand.worst_of), options.repeat)
    print(f"schedule as Python: {took:.0f} ms")
    if find_spec("numba"):
        kernel.dispatch.compile()
        schedule.schedule(tasks, MILLISECOND, MultiframeDemand.worst_of)
        took = least_time(lambda: schedule.schedule(tasks, cycle, MultiframeDemand.worst_of), options.repeat)
        print(f"schedule compiled: {took:.1f} ms")
    jobs = schedule.schedule(tasks, 2 * cycle, MultiframeDemand.worst_of)
    for length in (5, 10, LENGTH):
        chains = [random.sample(range(len(tasks)), length) for _ in range(20)]
        took = least_time(lambda chains=chains: [four_quantities(jobs, chain, cycle) for chain in chains], options.repeat)
        print(f"four exact quantities of a chain of {length}: {took / len(chains):.2f} ms")
    chains = [random.sample(range(len(tasks)), LENGTH) for _ in range(1000)]
    took = least_time(lambda: [four_quantities(jobs, chain, cycle) for chain in chains], 1)
    print(f"1,000 chains of {LENGTH}: {took / 1000:.2f} s")
    system = whole_system(tasks, chains)
    took = least_time(lambda: analyze_system(system), 1)
    print(f"a whole system with 1,000 chains of {LENGTH}, resolved, by all methods: {took / 1000:.2f} s")


if __name__ == "__main__":
    main()
