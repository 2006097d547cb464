"""A run of the kernel, and what is observed in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import partial

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.layout import Observation
from amalthea_uros.simulate.metrics import chains, jobs
from amalthea_uros.simulate.metrics.chains import RouteMetrics
from amalthea_uros.simulate.metrics.jobs import JobMetrics
from amalthea_uros.simulate.metrics.kept_values import KeptValues
from amalthea_uros.simulate.metrics.observers import Observers
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.build import KernelProgram
from amalthea_uros.simulate.program.host_system import host_name
from amalthea_uros.simulate.runs.driver import KernelDriver
from amalthea_uros.timing.blocking.critical_sections import spinlocks_of
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.trace.derived_events import RunnableSuspensions, SemaphoreStates
from amalthea_uros.trace.sinks import TraceSink
from amalthea_uros.trace.table import EntityKind, EventTable
from amalthea_uros.units import time_text


@dataclass(slots=True)
class SimulationRun:
    """A run, and what is observed in it.

    Attributes
    ----------
    kept : keeps single values; None if nobody needs them
    end : of the run in time units; it is earlier than planned if nothing can be simulated any more
    """

    context: TimingContext
    options: Options
    program: KernelProgram
    kept: KeptValues | None = None
    end: int = field(init=False)
    driver: KernelDriver = field(init=False)
    jobs: list[JobMetrics] = field(init=False)
    routes: list[RouteMetrics] = field(init=False)
    observers: Observers = field(init=False)
    runnables: list[JobMetrics] = field(init=False)
    handles: list[JobMetrics] = field(init=False)
    sinks: Sequence[TraceSink] = ()
    suspensions: RunnableSuspensions = field(default_factory=RunnableSuspensions)
    semaphores: SemaphoreStates = field(init=False)

    def __post_init__(self) -> None:
        program = self.program
        self.end = self.options.duration * program.units
        self.jobs = [JobMetrics(program.units) for _ in program.processes]
        self.runnables = [JobMetrics(program.units) for _ in program.runnables]
        self.handles = [JobMetrics(program.units, keep) for keep in self._kept_calls()]
        self.observers = Observers(self.context.system, self.options, program, self.end)
        keep = None if self.kept is None else self.kept.add_latencies
        self.routes = [RouteMetrics(program.units, keep and partial(keep, route.chain)) for route in program.routes]
        self.semaphores = _semaphore_states(self.context.system, program)
        traced = self.options.traced or (0, 0)
        self.driver = KernelDriver(
            program,
            until=self.end,
            jobs=lambda rows: jobs.add_rows(rows, [*self.jobs, *self.runnables, *self.handles]),
            observations=self._observe,
            events=self._write,
            traced=(traced[0] * program.units, traced[1] * program.units),
        )

    def _kept_calls(self) -> Iterator[Callable[[Numbers], None] | None]:
        """The functions that keep the calls of each handle."""
        executors = {executor.name: executor for executor in self.context.system.executors}
        of_host = {host_name(executor) for executor in self.context.system.host.executors}
        if self.kept is not None:
            self.kept.units = self.program.units
        for executor, name in self.program.handles:
            if executor in of_host:
                yield None if self.kept is None else partial(self.kept.add_calls, name, name)
                continue
            (runnable,) = (handle.runnable for handle in executors[executor].handles if handle.name == name)
            yield None if self.kept is None else partial(self.kept.add_calls, runnable, name)

    def execute(self, sinks: Sequence[TraceSink]) -> None:
        """Run to the end, and write the events."""
        self.sinks = sinks
        self.driver.run()
        if self.driver.has_ended_early:
            now = int(self.driver.memory[layout.NOW])
            self.end = max(1, now)
            self._say_why_it_ended(time_text(Fraction(now, self.program.units)))

    def _say_why_it_ended(self, at: str) -> None:
        if self.driver.multiplied:
            message = f"at {at}, more than {self.driver.multiplied:,} messages are in transit or wait; the run ends there"
            self.context.notes.error("SIM006", message, None)
            return
        if self.driver.has_no_place:
            name = max(self.program.records, key=self.driver.pending)
            message = f"at {at}, {self.driver.pending(name):,} activations of {name!r} wait; the run ends there"
            self.context.notes.error("SIM007", message, self.context.system.processes[name])
            return
        name = next(name for name, record in self.program.records.items() if record == self.driver.endless)
        message = f"at {at}, {name!r} executes activities forever without taking time; the run ends there"
        self.context.notes.error("SIM003", message, self.context.system.processes[name])

    def _observe(self, rows: Numbers) -> None:
        """Give rows about chains and about other occurrences to those that they are for."""
        is_occurrence = rows[:, Observation.KIND] == layout.OCCURRENCE
        chains.add_rows(rows[~is_occurrence], self.routes)
        self.observers.add(rows[is_occurrence])

    def _write(self, rows: Numbers) -> None:
        """Hand events on to all sinks."""
        table = self.suspensions.insert(self.semaphores.complete(_event_table(rows, self.program)))
        for sink in self.sinks:
            sink.write(table)


def _semaphore_states(system: System, program: KernelProgram) -> SemaphoreStates:
    """What makes the state chart of BTF of the events of semaphores."""
    numbers = {entity.name: number for number, entity in enumerate(program.entities) if entity.kind is EntityKind.SEMAPHORE}
    users = {numbers[semaphore.name]: semaphore.users for semaphore in system.os.semaphores}
    return SemaphoreStates(users, spinlocks=[numbers[name] for name in spinlocks_of(system)])


def _event_table(rows: Numbers, program: KernelProgram) -> EventTable:
    """Events in picoseconds, as the table of a trace."""
    time, kind, source, source_instance, target, target_instance, note = rows.T
    return EventTable(
        entities=program.entities,
        time=time // program.units,
        kind=kind.astype(np.int16),
        source=source.astype(np.int32),
        source_instance=source_instance,
        target=target.astype(np.int32),
        target_instance=target_instance,
        note=note,
    )
