"""How fast systems are simulated: task sets beside simso, an application of three tasks, a model of the size of a challenge, many runs.

python benchmarks/simulation.py
python benchmarks/simulation.py --model real.amxmi --frequency 300MHz
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from random import Random
from time import perf_counter

from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.origin import SystemOrigin
from amalthea_uros.perf import mapping, software, stimuli
from amalthea_uros.perf import os as perf_os
from amalthea_uros.perf.activities import Demand, Execute
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.system import System
from amalthea_uros.services.subject import open_system
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Duration, parse_frequency

ROOT = Path(__file__).parents[1]
MILLISECOND = 10**9
SECOND = 10**12
PERIODS = (1, 2, 2, 5, 5, 10, 10, 20, 50, 100)


@dataclass(frozen=True, slots=True)
class PlainTask:
    """A periodic task; the demand is in microseconds, the period in milliseconds, and shorter periods come first."""

    name: str
    period: int
    demand: int


def task_set(random: Random) -> list[PlainTask]:
    """Ten tasks at 70 % load."""
    shares = [random.random() + 0.2 for _ in PERIODS]
    return [
        PlainTask(f"T{index}", period, max(1, int(1000 * period * 0.7 * share / sum(shares))))
        for index, (period, share) in enumerate(zip(PERIODS, shares, strict=True))
    ]


def as_system(tasks: list[PlainTask]) -> System:
    """The tasks on one core whose tick is a microsecond."""
    structure = Structure(name="ecu", cores=(Core(name="core", clock="clock"),))
    return System(
        hardware=Hardware(clocks=(Clock(name="clock", frequency=parse_frequency("1MHz")),), structures=(structure,)),
        os=perf_os.Os(
            systems=(
                perf_os.OperatingSystem(
                    name="os",
                    schedulers=(perf_os.Scheduler(name="s", policy=perf_os.Policy.FIXED_PRIORITY_PREEMPTIVE, cores=("core",)),),
                ),
            )
        ),
        stimuli=stimuli.Stimuli(
            stimuli=tuple(stimuli.Periodic(name=f"S{t.name}", period=t.period * MILLISECOND) for t in tasks)
        ),
        software=software.Software(
            tasks=tuple(
                software.Task(
                    name=t.name,
                    stimuli=(f"S{t.name}",),
                    activities=(Execute(demand=Demand(ticks=Constant(t.demand))),),
                    activation_limit=10,
                )
                for t in tasks
            )
        ),
        mapping=mapping.Mapping(
            tasks=tuple(
                mapping.TaskAllocation(task=t.name, scheduler="s", priority=len(tasks) - index) for index, t in enumerate(tasks)
            )
        ),
    )


def scheduling_events(found: Simulation) -> int:
    """Activations, starts, preemptions, resumptions and terminations."""
    return sum(3 * process.jobs + 2 * process.preemptions.total for process in found.processes)


def jobs(found: Simulation) -> int:
    """The jobs that have ended."""
    return sum(process.jobs for process in found.processes)


def simso_jobs(tasks: list[PlainTask], milliseconds: int) -> int:
    """The jobs that simso plays of the same tasks."""
    from simso.configuration import Configuration
    from simso.core import Model

    configuration = Configuration()
    configuration.duration = milliseconds * configuration.cycles_per_ms
    for index, task in enumerate(tasks):
        configuration.add_task(
            name=task.name,
            identifier=index + 1,
            period=task.period,
            activation_date=0,
            wcet=task.demand / 1000,
            deadline=task.period,
        )
    configuration.add_processor(name="core", identifier=1)
    configuration.scheduler_info.clas = "simso.schedulers.RM_mono"
    configuration.check_all()
    model = Model(configuration)
    model.run_model()
    return sum(len(found.jobs) for found in model.results.tasks.values())


def timed(work: Callable[[], Simulation], repeat: int) -> tuple[float, Simulation]:
    """The least time of some runs, and the result."""
    best, found = float("inf"), work()
    for _ in range(repeat):
        start = perf_counter()
        found = work()
        best = min(best, perf_counter() - start)
    return best, found


class Interpreted:
    """While it is entered, the kernel is not made machine code."""

    def __enter__(self) -> None:
        self._kept = machine_code.is_worth_it
        machine_code.is_worth_it = lambda seconds, left: False

    def __exit__(self, *_: object) -> None:
        machine_code.is_worth_it = self._kept


class Compiled:
    """While it is entered, the kernel is machine code from the second window on."""

    def __enter__(self) -> None:
        self._kept = machine_code.is_worth_it
        machine_code.compiled()
        machine_code.is_worth_it = lambda seconds, left: True

    def __exit__(self, *_: object) -> None:
        machine_code.is_worth_it = self._kept


def main() -> None:
    """Measure everything."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--model", type=Path, help="a model of one's own, e.g. that of a challenge")
    parser.add_argument("--frequency", default="300MHz", help="of all its cores")
    arguments = parser.parse_args()
    tasks = task_set(Random(1))
    system = as_system(tasks)
    ways = [("interpreted", Interpreted(), 20)]
    if find_spec("numba"):
        ways.append(("machine code", Compiled(), 2000))
    print("ten tasks at 70 % load, scheduling events")
    if find_spec("simso"):
        start = perf_counter()
        count = simso_jobs(tasks, 2000)
        print(f"  simso {count / (perf_counter() - start):>12,.0f} jobs/s")
    for name, way, seconds in ways:
        with way:
            options = Options(duration=Duration(seconds * SECOND))
            time, found = timed(partial(simulate_system, system, options), arguments.repeat)
        print(f"  {name}: {jobs(found) / time:,.0f} jobs/s, {scheduling_events(found) / time:,.0f} events/s")
    thesis = open_system((ROOT / "samples" / "bodas-test-advanced.yaml",)).system
    for name, way, _ in ways:
        with way:
            time, found = timed(lambda: simulate_system(thesis, Options(duration=Duration(300 * SECOND))), arguments.repeat)
        print(f"bodas-test-advanced, 5 min, {name}: {time:.2f} s, {jobs(found):,} jobs")
    if arguments.model is not None:
        opened = open_system((arguments.model,)).system
        frequency = parse_frequency(arguments.frequency)
        settings = Settings(frequencies=dict.fromkeys(opened.cores, frequency))
        for name, way, _ in ways:
            with way:
                short, _ = timed(
                    lambda: simulate_system(opened, Options(duration=Duration(SECOND), settings=settings)), arguments.repeat
                )
                long, found = timed(
                    lambda: simulate_system(opened, Options(duration=Duration(11 * SECOND), settings=settings)),
                    arguments.repeat,
                )
            print(
                f"{arguments.model.name}, {name}: {(long - short) / 10:.3f} s per second of model time, {short:.2f} s at first"
            )
    runs(system, arguments.repeat)


def runs(system: System, repeat: int) -> None:
    """A thousand runs with different seeds, on one and on all cores."""
    from amalthea_uros.design.campaign.campaign import run_campaign
    from amalthea_uros.design.campaign.executors import processes, serial
    from amalthea_uros.design.campaign.run import plan_runs
    from amalthea_uros.design.campaign.simulations import SimulationJob

    job, planned = (
        SimulationJob(SystemOrigin(Configuration(system, Settings())), Options(duration=Duration(SECOND // 10))),
        plan_runs([], 1000, 1),
    )
    cores = os.cpu_count() or 1
    for name, executor in (("1 process", serial), (f"{cores} processes", processes(cores))):
        start = perf_counter()
        count = sum(1 for _ in run_campaign(job, planned, executor))
        print(f"{count:,} runs of 100 ms, {name}: {perf_counter() - start:.1f} s")


if __name__ == "__main__":
    main()
