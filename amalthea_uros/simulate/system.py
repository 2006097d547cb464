"""Simulations of whole systems."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.plural import counted
from amalthea_uros.judge.limits import Deadline, deadline_of
from amalthea_uros.perf.software import Isr
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.driver import EndlessJobError, KernelDriver
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.layout import Observation
from amalthea_uros.simulate.kernel.operations import POLLING, RUNNING
from amalthea_uros.simulate.metrics import chains, jobs
from amalthea_uros.simulate.metrics.chains import RouteMetrics, chain_observation
from amalthea_uros.simulate.metrics.jobs import JobMetrics
from amalthea_uros.simulate.metrics.observers import Observers
from amalthea_uros.simulate.not_simulated import NotSimulated
from amalthea_uros.simulate.observed_limits import LOOPING, judge_process, judge_requirements
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.build import KernelProgram, build_program
from amalthea_uros.simulate.results import (
    ChainObservation,
    CoreObservation,
    CountObservation,
    ProcessObservation,
    RunnableObservation,
    Simulation,
)
from amalthea_uros.timing.activation.phases import with_first_arrivals
from amalthea_uros.timing.activation.releases import ASSUMPTION
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.blocking.critical_sections import spinlocks_of
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.trace.derived_events import RunnableSuspensions, SemaphoreStates
from amalthea_uros.trace.sinks import TraceSink
from amalthea_uros.trace.table import Entity, EntityKind, EventTable
from amalthea_uros.units import time_text

#: Opens what the events of a run are written to, when the entities are known.
OpenSink: TypeAlias = "Callable[[Sequence[Entity]], TraceSink]"


def simulate_system(system: System, options: Options, sinks: Sequence[OpenSink] = ()) -> Simulation:
    """Simulate a system once.

    Processes and chains that cannot be simulated are findings; the others are simulated as if they did not exist.

    Parameters
    ----------
    sinks : for the events of `options.traced`
    """
    context = TimingContext.of_scheduling(with_first_arrivals(system, options.settings.phases), options.settings)
    program = build_program(context, options)
    run = _SimulationRun(context, options, program)
    with ExitStack() as stack:
        run.execute([stack.enter_context(open_sink(program.entities)) for open_sink in sinks])
    return run.result()


@dataclass(slots=True)
class _SimulationRun:
    """A run, and what is observed in it.

    Attributes
    ----------
    end : of the run in time units; it is earlier than planned if nothing can be simulated any more
    """

    context: TimingContext
    options: Options
    program: KernelProgram
    end: int = field(init=False)
    player: KernelDriver = field(init=False)
    jobs: list[JobMetrics] = field(init=False)
    routes: list[RouteMetrics] = field(init=False)
    observers: Observers = field(init=False)
    runnables: list[JobMetrics] = field(init=False)
    sinks: Sequence[TraceSink] = ()
    suspensions: RunnableSuspensions = field(default_factory=RunnableSuspensions)
    semaphores: SemaphoreStates = field(init=False)

    def __post_init__(self) -> None:
        program = self.program
        self.end = self.options.duration * program.units
        self.jobs = [JobMetrics(program.units) for _ in program.processes]
        self.runnables = [JobMetrics(program.units) for _ in program.runnables]
        self.observers = Observers(self.context.system, self.options, program, self.end)
        self.routes = [RouteMetrics(program.units) for _ in program.routes]
        self.semaphores = _semaphore_states(self.context.system, program)
        traced = self.options.traced or (0, 0)
        self.player = KernelDriver(
            program,
            until=self.end,
            jobs=lambda rows: jobs.add_rows(rows, [*self.jobs, *self.runnables]),
            observations=self._observe,
            events=self._write,
            traced=(traced[0] * program.units, traced[1] * program.units),
        )

    def execute(self, sinks: Sequence[TraceSink]) -> None:
        """Run to the end, and write the events."""
        self.sinks = sinks
        try:
            self.player.run()
        except EndlessJobError as error:
            name = next(name for name, record in self.program.records.items() if record == error.args[0])
            now = int(self.player.memory[layout.NOW])
            self.end = max(1, now)
            at = time_text(Fraction(now, self.program.units))
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

    def result(self) -> Simulation:
        """What was observed."""
        system, program, notes = self.context.system, self.program, self.context.notes
        self._note_left_out()
        self.observers.finish()
        left_out = NotSimulated(self.context, frozenset(program.left_out))
        processes = Results(
            judge_process(
                each,
                system.processes[each.name],
                left_out.doubt_about(each.name),
                LOOPING if each.name in system.executor_of_task else "",
            )
            for each in self._processes()
        )
        found = Results(self._chain(name) for name in system.chains)
        duration = self.options.duration
        runnables = Results(map(self._runnable, self.program.runnables, self.runnables))
        doubts = left_out.doubt_about_limits()
        requirements = Results(judge_requirements(system, processes, found, duration, runnables, self.observers, doubts))
        return Simulation(
            duration=duration,
            seed=self.options.seed,
            mode=self.options.mode,
            cores=Results(self._core(name, record) for name, record in program.cores.items()),
            processes=processes,
            left_out=Results(self._left_out(name, reason) for name, reason in program.left_out.items()),
            chains=found,
            runnables=runnables,
            labels=Results(self.observers.labels()),
            requirements=requirements,
            assumptions=tuple(notes.assumptions),
            findings=tuple(finding for finding in notes.found if finding.rule not in _OF_ANALYSES),
        )

    def _note_left_out(self) -> None:
        """Make findings of what is not simulated."""
        system, notes = self.context.system, self.context.notes
        for name, reason in self.program.left_out.items():
            notes.error("SIM001", f"{name!r} is not simulated: {reason}", system.processes[name])
        for executor in system.executors:
            message = (
                f"the loop of {executor.name!r} is not simulated: its task executes iterations that call by chance what may be ready, "
                "so that the times of its callbacks, and of what they send or activate, are not those of the executor"
            )
            notes.warning("SIM006", message, executor)
        for name, reason in self.program.chains_left_out.items():
            notes.warning("SIM002", f"the chain {name!r} is not followed: {reason}", system.chains[name])
        for name, record in self.program.channels.items():
            lost = int(self.player.memory[record + layout.OVERFLOWS])
            if lost:
                message = f"the channel {name!r} was full: {counted(lost, 'element')} lost"
                notes.warning("SIM004", message, system.channels[name])
        for (process, source), queue in self.program.messages.items():
            lost = int(self.player.memory[queue + layout.LOST_MESSAGES])
            if lost:
                message = (
                    f"the queue of {source!r} was full: {counted(lost, 'message')} lost, because {process!r} takes one in a job"
                )
                notes.warning("SIM005", message, system.processes[process])

    # Cores and processes.

    def _processes(self) -> Iterator[ProcessObservation]:
        for name, found in zip(self.program.processes, self.jobs, strict=True):
            yield self._process(name, found)

    def _deadline(self, name: str) -> Deadline | None:
        # The rounds of an executor that loops follow each other as they do not in a simulation: no verdict on them is right.
        deadline = None if name in self.context.system.executor_of_task else deadline_of(name, self.context)
        if deadline is not None and deadline.is_implicit:
            self.context.notes.assume(ASSUMPTION)
        return deadline

    def _left_out(self, name: str, reason: str) -> ProcessObservation:
        """A process that is not simulated."""
        process, deadline, placement = self.context.system.processes[name], self._deadline(name), self.context.placement(name)
        none = CountObservation(total=0, min=0, max=0)
        seen = ProcessObservation(
            name=name,
            is_isr=isinstance(process, Isr),
            core=placement.core,
            priority=placement.priority,
            jobs=0,
            load=Fraction(0),
            metrics={},
            preemptions=none,
            migrations=none,
            deadline=None if deadline is None else deadline.value,
            is_implicit=deadline is not None and deadline.is_implicit,
        )
        return judge_process(seen, process, left_out=reason)

    def _process(self, name: str, found: JobMetrics) -> ProcessObservation:
        memory, record, deadline = self.player.memory, self.program.records[name], self._deadline(name)
        pending = self.player.pending(name)
        used = found.total(JobMetric.RUNNING_TIME) + found.total(JobMetric.POLLING_TIME) + self._used_by_last_job(record)
        placement = self.context.placement(name)
        waited = self.end - int(memory[record + layout.ACTIVATION]) if pending else 0
        return ProcessObservation(
            name=name,
            is_isr=isinstance(self.context.system.processes[name], Isr),
            core=placement.core,
            priority=placement.priority,
            jobs=found.count,
            load=Fraction(used, self.end),
            metrics=found.observations(None if deadline is None else deadline.value),
            preemptions=found.preemptions,
            migrations=found.migrations,
            lost_activations=int(memory[record + layout.LOST]),
            unfinished=pending,
            longest_unfinished=Fraction(waited, self.program.units),
            deadline=None if deadline is None else deadline.value,
            is_implicit=deadline is not None and deadline.is_implicit,
        )

    def _used_by_last_job(self, record: int) -> int:
        """The time in which the job that has not ended has had a core."""
        memory = self.player.memory
        used = int(memory[record + layout.TIME_RUNNING]) + int(memory[record + layout.TIME_POLLING])
        is_on_core = memory[record + layout.STATE] in (RUNNING, POLLING)
        return used + (self.end - int(memory[record + layout.SINCE]) if is_on_core else 0)

    def _runnable(self, name: str, found: JobMetrics) -> RunnableObservation:
        return RunnableObservation(
            name=name,
            executions=found.count,
            metrics=found.observations(None),
            preemptions=found.preemptions,
            migrations=found.migrations,
        )

    def _core(self, name: str, record: int) -> CoreObservation:
        memory = self.player.memory
        last = self.end - int(memory[record + layout.BEGIN]) if memory[record + layout.RUNS] else 0
        return CoreObservation(name=name, load=Fraction(int(memory[record + layout.BUSY]) + last, self.end))

    def _chain(self, name: str) -> ChainObservation:
        routes = [(route.text, self.routes[number]) for number, route in enumerate(self.program.routes) if route.chain == name]
        return chain_observation(name, routes, self.end, self.program.chains_left_out.get(name, ""))


#: Findings about what only analyses do not know.
_OF_ANALYSES = ("ANA002", "ANA003", "ANA004", "ANA005", "ANA007")


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
