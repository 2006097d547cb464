"""Simulations of systems by the product, with every row that its kernel reports."""

from __future__ import annotations

from dataclasses import dataclass, field
from unittest.mock import patch

from amalthea_uros.perf.system import System
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.build import KernelProgram, build_program
from amalthea_uros.simulate.runs.driver import KernelDriver
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.observed.job_times import JobColumn as Column

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
    """Simulate a system, interpreted or compiled, and keep everything that the kernel reports."""
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
