"""How long response times take: many tasks on one core and on several, and a model of the size of the challenge of 2017.

Where numba is installed, everything is measured as Python and as machine code.

python benchmarks/response_times.py --repeat 5
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from fractions import Fraction
from importlib.util import find_spec
from random import Random

from amalthea_uros.analyze.response_times import kernel, priority_levels
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf import activities, mapping, os, software, stimuli
from amalthea_uros.perf.distributions import Statistics
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.system import System
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import PeriodicEvents

PERIODS = (1, 2, 5, 10, 20, 50, 100, 200, 1000)
MILLISECOND = 10**9


def task_set(count: int, load: float, random: Random, jitter: bool) -> list[AnalysedTask]:
    """Periodic tasks with rate-monotonic priorities, and perhaps jitter of up to a tenth of the period."""
    shares = [random.random() for _ in range(count)]
    periods = sorted(random.choice(PERIODS) * MILLISECOND for _ in range(count))
    return [
        AnalysedTask(
            name=f"T{index}",
            events=PeriodicEvents(period, random.randrange(period // 10) if jitter else 0),
            demand=MultiframeDemand.constant(max(1, int(period * load * share / sum(shares)))),
            priority=-index,
        )
        for index, (period, share) in enumerate(zip(periods, shares, strict=True))
    ]


def challenge_system(random: Random) -> System:
    """21 tasks on four cores with 1,250 runnables and 15,255 label accesses; one task arrives sporadically on each core."""
    cores = [f"Core_{index}" for index in range(4)]
    labels = [software.Label(name=f"L{index}", size=32) for index in range(1000)]
    runnables = []
    for index in range(1250):
        accesses = tuple(
            activities.LabelAccess(label=random.choice(labels).name, kind=random.choice(list(activities.AccessKind)))
            for _ in range(12 + (index < 255))
        )
        ticks = Statistics(lower=500, average=1000.0, upper=2000)
        execute = activities.Execute(demand=activities.Demand(ticks))
        runnables.append(software.Runnable(name=f"R{index}", activities=(*accesses, execute)))
    tasks, allocations, sources = [], [], []
    for index in range(21):
        calls = tuple(activities.Call(runnable=runnable.name) for runnable in runnables[index::21])
        tasks.append(software.Task(name=f"T{index}", stimuli=(f"S{index}",), activities=calls))
        allocations.append(mapping.TaskAllocation(task=f"T{index}", scheduler=cores[index % 4], priority=21 - index))
        jitter = Statistics(lower=0, average=10**6, upper=10**7) if index < 4 else None
        sources.append(stimuli.Periodic(name=f"S{index}", period=(5 + index) * MILLISECOND, jitter=jitter))
    schedulers = tuple(os.Scheduler(name=core, policy=os.Policy.OSEK, cores=(core,)) for core in cores)
    return System(
        hardware=Hardware(
            clocks=(Clock(name="clock", frequency=Fraction(300 * 10**6)),),
            structures=(Structure(name="ECU", cores=tuple(Core(name=core, clock="clock") for core in cores)),),
        ),
        os=os.Os(systems=(os.OperatingSystem(name="OS", schedulers=schedulers),)),
        stimuli=stimuli.Stimuli(stimuli=tuple(sources)),
        software=software.Software(tasks=tuple(tasks), runnables=tuple(runnables), labels=tuple(labels)),
        mapping=mapping.Mapping(tasks=tuple(allocations)),
    )


def least_time(work: Callable[[], object], repeat: int) -> float:
    """The minimum time of several runs, in milliseconds."""
    times = []
    for _ in range(repeat):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times) * 1000


def measure(random: Random, repeat: int, how: str) -> None:
    """Print one line for each kind of work."""
    for jitter in (False, True):
        for cores in (1, 4):
            sets = [task_set(1000, 0.7, random, jitter) for _ in range(cores)]
            took = least_time(lambda sets=sets: [priority_levels.response_times(s) for s in sets], repeat)
            kind = "with jitter" if jitter else "without jitter"
            print(f"{how}: {cores} x 1,000 tasks at 70 % load, {kind}: {took:.1f} ms")
    system = challenge_system(random)
    took = least_time(lambda: analyze_system(system), repeat)
    print(f"{how}: 21 tasks with 1,250 runnables and 15,255 label accesses: {took:.1f} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    loops = (kernel.demand_in, kernel.least_fixed_point, kernel.greatest_fixed_point)
    for loop in loops:
        loop.keep_python()
    measure(Random(1), options.repeat, "Python")
    if find_spec("numba"):
        for loop in loops:
            loop.compile()
        priority_levels.response_times(task_set(10, 0.7, Random(1), True))
        measure(Random(1), options.repeat, "compiled")


if __name__ == "__main__":
    main()
