"""Simulations of systems by the product, interpreted, with every job."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from unittest.mock import patch

import numpy as np
from opponent.observation import Horizon
from opponent.systems import PlainSystem
from opponent.to_perf import MICROSECOND, to_perf

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.kernel.layout import STIMULUS, Observation
from amalthea_uros.simulate.metrics.chains import RouteMetrics, chain_observation
from amalthea_uros.simulate.observations import MetricObservation
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.program.build import KernelProgram, build_program
from amalthea_uros.simulate.runs.driver import KernelDriver
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.observed.job_times import JobColumn as Column

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

#: Activation, start and end of a job, in picoseconds.
SimulatedJob = tuple[int, int, int]


@dataclass(slots=True)
class Recording:
    """The rows of a simulation.

    Attributes
    ----------
    jobs, observations, events : as the kernel reports them, in time units
    """

    program: KernelProgram
    jobs: list[list[int]] = field(default_factory=list)
    observations: list[list[int]] = field(default_factory=list)
    events: list[list[int]] = field(default_factory=list)

    def jobs_of(self, process: str) -> list[SimulatedJob]:
        """The jobs of a process that have ended, in their order."""
        number, units = self.program.processes.index(process), self.program.units
        columns = (Column.ACTIVATION, Column.START, Column.END)
        found = (row for row in self.jobs if row[Column.PROCESS] == number)
        return [(row[columns[0]] // units, row[columns[1]] // units, row[columns[2]] // units) for row in found]


def record(system: System, options: Options, *, is_compiled: bool = False) -> Recording:
    """Simulate a system, and keep everything that the kernel reports."""
    program = build_program(TimingContext.of_scheduling(system, options.settings), options)
    found = Recording(program)
    traced = options.traced or (0, 0)
    player = KernelDriver(
        program,
        until=options.duration * program.units,
        jobs=lambda rows: found.jobs.extend(rows.tolist()),
        observations=lambda rows: found.observations.extend(rows.tolist()),
        events=lambda rows: found.events.extend(rows.tolist()),
        traced=(traced[0] * program.units, traced[1] * program.units),
    )
    with patch.object(machine_code, "is_worth_it", lambda _seconds, _left: is_compiled):
        player.run()
    return found


def contradictions(plain: PlainSystem, seeds: Iterable[int] = (1,), modes: Iterable[Mode] = tuple(Mode)) -> list[str]:
    """Where simulations show what the analysis says cannot be."""
    system, horizon = to_perf(plain), Horizon.of(plain)
    return list(beyond(analyze_system(system), _runs(system, horizon, seeds, modes), horizon.begin * MICROSECOND))


def _runs(system: System, horizon: Horizon, seeds: Iterable[int], modes: Iterable[Mode]) -> Iterator[Recording]:
    for mode in modes:
        for seed in seeds if mode is Mode.SAMPLED else (1,):
            yield record(system, Options(duration=horizon.end * MICROSECOND, seed=seed, mode=mode))


def beyond(analysis: Analysis, runs: Iterable[Recording], steady: int) -> Iterator[str]:
    """What runs show beyond the claims of an analysis; best cases and latencies are claimed for the steady state."""
    for run in runs:
        for process in analysis.processes:
            response, jobs = process.response, run.jobs_of(process.name)
            if response is None or not jobs:
                continue
            longest = max(end - activation for activation, _, end in jobs)
            shortest = min((end - activation for activation, _, end in jobs if activation >= steady), default=response.best)
            if response.worst is not None and longest > response.worst:
                yield f"{process.name}: {longest} beyond {response.worst} by {response.method}"
            if shortest < response.best:
                yield f"{process.name}: {shortest} below {response.best} by {response.method}"
        yield from _beyond_latencies(analysis, run, steady)


def _beyond_latencies(analysis: Analysis, run: Recording, steady: int) -> Iterator[str]:
    for chain in analysis.chains:
        observed = latencies(run, chain.name, steady)
        for value in chain.all_values:
            side, _, quantity = value.quantity.value.partition("_")
            found = observed.get(quantity)
            if value.value is None or found is None or side not in ("max", "min"):
                continue
            if found.max > value.value if side == "max" else found.min < value.value:
                yield f"{chain.name}: {value.quantity} {found} beyond {value.value} by {value.method}"


def latencies(run: Recording, chain: str, steady: int) -> Mapping[str, MetricObservation]:
    """The latencies of a chain by their names, of what occurs from a time on."""
    rows = np.array(run.observations, np.int64).reshape(-1, len(Observation))
    late = rows[rows[:, Observation.TIME] >= steady * run.program.units]
    routes = []
    for number, route in enumerate(run.program.routes):
        if route.chain == chain:
            metrics = RouteMetrics(run.program.units)
            metrics.add(_renumbered(late[late[:, Observation.ROUTE] == number]))
            routes.append((route.text, metrics))
    found = chain_observation(chain, routes, steady, "").quantities
    return {quantity.value: observation for quantity, observation in found.items()}


def _renumbered(rows: Numbers) -> Numbers:
    """Observations of a part of a run, with stimuli counted from its beginning; responses to earlier ones are left out."""
    is_stimulus = rows[:, Observation.KIND] == STIMULUS
    if not is_stimulus.any():
        return rows[:0]
    first = rows[is_stimulus, Observation.STAMP][0]
    kept = rows[rows[:, Observation.STAMP] >= first].copy()
    kept[:, Observation.STAMP] -= first
    return kept
