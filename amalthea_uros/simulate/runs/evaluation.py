"""The evaluation of a run: what was observed of each thing, and the verdicts on it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.judge.limits import Deadline, deadline_of
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.perf.software import Isr
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.layout import POLLING, RUNNING
from amalthea_uros.simulate.metrics.chains import chain_observation
from amalthea_uros.simulate.metrics.jobs import JobMetrics
from amalthea_uros.simulate.observations import (
    ChainObservation,
    CoreObservation,
    CountObservation,
    ExecutorObservation,
    HandleObservation,
    LossObservation,
    ProcessObservation,
    RunnableObservation,
)
from amalthea_uros.simulate.program.build import KernelProgram
from amalthea_uros.simulate.program.host_system import host_name, thread_names
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.runs.execution import SimulationRun
from amalthea_uros.simulate.runs.not_simulated import NotSimulated
from amalthea_uros.simulate.runs.observed_limits import judge_process, judge_requirements
from amalthea_uros.timing.activation.releases import ASSUMPTION
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.context import TimingContext

#: Findings about what only analyses do not know.
_OF_ANALYSES = ("ANA002", "ANA003", "ANA004", "ANA005", "ANA007")


@dataclass(slots=True)
class RunEvaluation:
    """What a run has shown of each thing."""

    run: SimulationRun
    context: TimingContext = field(init=False)
    program: KernelProgram = field(init=False)

    def __post_init__(self) -> None:
        self.context, self.program = self.run.context, self.run.program

    def result(self) -> Simulation:
        """What was observed."""
        system, program, notes = self.context.system, self.program, self.context.notes
        self._note_left_out()
        self.run.observers.finish()
        left_out = NotSimulated(self.context, frozenset(program.left_out))
        processes = Results(
            judge_process(each, system.processes[each.name], left_out.doubt_about(each.name)) for each in self._processes()
        )
        found = Results(self._chain(name) for name in system.chains)
        duration = self.run.options.duration
        runnables = Results(map(self._runnable, self.program.runnables, self.run.runnables))
        doubts = left_out.doubt_about_limits()
        executors = Results(self._executors())
        limited = (*runnables, *(as_runnable(handle) for executor in executors for handle in executor.handles))
        requirements = Results(judge_requirements(system, processes, found, duration, limited, self.run.observers, doubts))
        return Simulation(
            duration=duration,
            seed=self.run.options.seed,
            mode=self.run.options.mode,
            cores=Results(self._core(name, record) for name, record in program.cores.items()),
            processes=processes,
            left_out=Results(
                self._left_out(name, reason) for name, reason in program.left_out.items() if name not in self._threads_of_host
            ),
            chains=found,
            executors=executors,
            host=Results(self._host()),
            losses=Results(self._losses()),
            runnables=runnables,
            labels=Results(self.run.observers.labels()),
            requirements=requirements,
            assumptions=tuple(notes.assumptions),
            findings=tuple(finding for finding in notes.found if finding.rule not in _OF_ANALYSES),
        )

    def _note_left_out(self) -> None:
        """Make findings of what is not simulated."""
        system, notes = self.context.system, self.context.notes
        for name, reason in self.program.left_out.items():
            notes.error("SIM001", f"{name!r} is not simulated: {reason}", system.processes[name])
        for name, reason in self.program.chains_left_out.items():
            notes.warning("SIM002", f"the chain {name!r} is not followed: {reason}", system.chains[name])
        for name, record in self.program.channels.items():
            lost = int(self.run.driver.memory[record + layout.OVERFLOWS])
            if lost:
                message = f"the channel {name!r} was full: {counted(lost, 'element')} lost"
                notes.warning("SIM004", message, system.channels[name])
        for (process, source), queue in self.program.messages.items():
            lost = int(self.run.driver.memory[queue + layout.LOST_MESSAGES])
            if lost:
                message = (
                    f"the queue of {source!r} was full: {counted(lost, 'message')} lost, because {process!r} takes one in a job"
                )
                notes.warning("SIM005", message, system.processes[process])

    # Cores and processes.

    def _processes(self) -> Iterator[ProcessObservation]:
        for name, found in zip(self.program.processes, self.run.jobs, strict=True):
            if name not in self._threads_of_host:
                yield self._process(name, found)

    @property
    def _threads_of_host(self) -> frozenset[str]:
        """The tasks that stand for threads of the host, of which the executors of the host are observed instead."""
        return frozenset(name for executor in self.context.system.host.executors for name in thread_names(executor))

    def _deadline(self, name: str) -> Deadline | None:
        deadline = deadline_of(name, self.context)
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
        memory, record, deadline = self.run.driver.memory, self.program.records[name], self._deadline(name)
        pending = 0 if self._waits_for_data(record) else self.run.driver.pending(name)
        used = found.total(JobMetric.RUNNING_TIME) + found.total(JobMetric.POLLING_TIME) + self._used_by_last_job(record)
        placement = self.context.placement(name)
        waited = self.run.end - int(memory[record + layout.ACTIVATION]) if pending else 0
        return ProcessObservation(
            name=name,
            is_isr=isinstance(self.context.system.processes[name], Isr),
            core=placement.core,
            priority=placement.priority,
            jobs=found.count,
            load=Fraction(used, self.run.end),
            metrics=found.observations(None if deadline is None else deadline.value),
            preemptions=found.preemptions,
            migrations=found.migrations,
            lost_activations=int(memory[record + layout.LOST]),
            unfinished=pending,
            longest_unfinished=Fraction(waited, self.program.units),
            deadline=None if deadline is None else deadline.value,
            is_implicit=deadline is not None and deadline.is_implicit,
        )

    def _waits_for_data(self, record: int) -> bool:
        """Whether a process is in the wait of an executor, after which its next job begins."""
        memory = self.run.driver.memory
        reader = int(memory[record + layout.READS_WITH])
        return reader != 0 and int(memory[reader + layout.AWAITED]) == 0

    def _used_by_last_job(self, record: int) -> int:
        """The time in which the job that has not ended has had a core."""
        memory = self.run.driver.memory
        used = int(memory[record + layout.TIME_RUNNING]) + int(memory[record + layout.TIME_POLLING])
        is_on_core = memory[record + layout.STATE] in (RUNNING, POLLING)
        return used + (self.run.end - int(memory[record + layout.SINCE]) if is_on_core else 0)

    def _runnable(self, name: str, found: JobMetrics) -> RunnableObservation:
        return RunnableObservation(
            name=name,
            executions=found.count,
            metrics=found.observations(None),
            preemptions=found.preemptions,
            migrations=found.migrations,
        )

    def _executors(self) -> Iterator[ExecutorObservation]:
        """The executors that are simulated."""
        memory = self.run.driver.memory
        found = dict(zip(self.program.handles, self.run.handles, strict=True))
        for executor in self.context.system.executors:
            if executor.name not in self.program.executors:
                continue
            publications = self.program.executors[executor.name]
            yield ExecutorObservation(
                name=executor.name,
                iterations=self.run.jobs[self.program.processes.index(executor.task)].count,
                timeouts=int(sum(memory[record + layout.TIMEOUTS] for record in publications)),
                refusals=int(sum(memory[record + layout.REFUSALS] for record in publications)),
                handles=Results(
                    self._handle(executor, handle, found[executor.name, handle.name]) for handle in executor.handles
                ),
            )

    def _host(self) -> Iterator[ExecutorObservation]:
        """The executors of the host, if it is simulated."""
        memory, calls_of = self.run.driver.memory, dict(zip(self.program.handles, self.run.handles, strict=True))
        for executor in self.context.system.host.executors if self.program.host_handles else ():
            threads = map(self.program.processes.index, thread_names(executor))
            yield ExecutorObservation(
                name=executor.name,
                iterations=sum(self.run.jobs[number].count for number in threads),
                timeouts=0,
                handles=Results(
                    HandleObservation(
                        name=callback.name,
                        kind=callback.kind,
                        runnable=callback.name,
                        calls=calls.count,
                        metrics=calls.observations(None),
                        preemptions=calls.preemptions,
                        migrations=calls.migrations,
                        lost=int(memory[self.program.host_handles[callback.name] + layout.LOST_CALLS]),
                    )
                    for callback in executor.callbacks
                    for calls in [calls_of[host_name(executor), callback.name]]
                ),
            )

    def _losses(self) -> Iterator[LossObservation]:
        """The messages that were lost, of those that can be."""
        memory = self.run.driver.memory
        for name, record in self.program.lossy.items():
            yield LossObservation(
                name=name,
                wire=self.context.system.transmissions[name].wire,
                sent=int(memory[record + layout.DONE_WRITING]),
                lost=int(memory[record + layout.LOST_ON_WIRE]),
                sent_again=int(memory[record + layout.SENT_AGAIN]),
            )

    def _handle(self, executor: Executor, handle: Handle, found: JobMetrics) -> HandleObservation:
        record = self.program.handle_records[executor.name, handle.name]
        return HandleObservation(
            name=handle.name,
            kind=handle.kind,
            runnable=handle.runnable,
            calls=found.count,
            metrics=found.observations(None),
            preemptions=found.preemptions,
            migrations=found.migrations,
            lost=int(self.run.driver.memory[record + layout.LOST_CALLS]),
        )

    def _core(self, name: str, record: int) -> CoreObservation:
        memory = self.run.driver.memory
        last = self.run.end - int(memory[record + layout.BEGIN]) if memory[record + layout.RUNS] else 0
        return CoreObservation(name=name, load=Fraction(int(memory[record + layout.BUSY]) + last, self.run.end))

    def _chain(self, name: str) -> ChainObservation:
        routes = [
            (route.text, self.run.routes[number]) for number, route in enumerate(self.program.routes) if route.chain == name
        ]
        return chain_observation(name, routes, self.run.end, self.program.chains_left_out.get(name, ""))


def as_runnable(handle: HandleObservation) -> RunnableObservation:
    """The calls of a handle as those of its callback, of which requirements limit the response time from when it was asked for."""
    return RunnableObservation(
        name=handle.runnable,
        executions=handle.calls,
        metrics=handle.metrics,
        preemptions=handle.preemptions,
        migrations=handle.migrations,
    )
