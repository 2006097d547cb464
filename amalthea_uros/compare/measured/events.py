"""What the events of a trace measure: of processes, runnables and chains."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros.compare.measured.receptions import receptions
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.steps import iterations_name
from amalthea_uros.measure.begins import ChainBegin, ModelBegins
from amalthea_uros.measure.series import Measurement
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.perf.events import Event, ProcessChange, ProcessEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.network import Direction, Purpose
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.chains import sequences, unfold
from amalthea_uros.trace.readers import format_of, open_trace
from amalthea_uros.trace.table import EventKind

if TYPE_CHECKING:
    from amalthea_uros.trace.reading import TraceReader
    from amalthea_uros.trace.table import EventTable


#: The events of a job with which a chain can begin so that a trace shows it.
_BEGINS = {ProcessChange.ACTIVATE: EventKind.ACTIVATE, ProcessChange.START: EventKind.START}
WITHIN_A_JOB = "it begins or ends within a job, at an event that is not in traces; measure it between markers"
AT_HOST = (
    "it begins or ends at the host, which is not in traces of the controller; measure it there, and give the values as a table"
)


def begins_of(system: System) -> ModelBegins:
    """With which events the chains and the jobs of a system begin."""
    return ModelBegins(
        chains={**dict.fromkeys(receptions(system.host), EventKind.CHAIN_STEP), **dict(_chain_begins(system))},
        iterations={task: iterations_name(executor.name) for task, executor in system.executor_of_task.items()},
        callbacks=system.host.callback_names.union(
            handle.runnable for executor in system.executors for handle in executor.handles
        ),
    )


def _chain_begins(system: System) -> Iterator[tuple[str, ChainBegin]]:
    for chain in system.chains.values():
        try:
            ways = sequences(unfold(chain, system)[0])
            routes = [(system.events_by_name[way[0]], system.events_by_name[way[-1]]) for way in ways]
        except UnknownError:
            continue
        if any(
            _is_at_host(first, Direction.TO_CONTROLLER, system) or _is_at_host(last, Direction.TO_AGENT, system)
            for first, last in routes
        ):
            yield chain.name, AT_HOST
            continue
        begins = {_begin(first, system) for first, _ in routes}
        is_shown = len(begins) == 1 and all(_ends_with_its_step(last) for _, last in routes)
        yield chain.name, begins.pop() if is_shown else WITHIN_A_JOB


def _is_at_host(event: Event, direction: Direction, system: System) -> bool:
    """Whether it is a message whose time in the agent counts: a chain begins when the host publishes, and ends when it has it."""
    transmission = system.transmissions.get(event.process or "") if isinstance(event, ProcessEvent) else None
    return transmission is not None and (transmission.direction, transmission.purpose) == (direction, Purpose.DATA)


def _begin(event: Event, system: System) -> ChainBegin:
    # An iteration is no job that something activates.
    if not isinstance(event, ProcessEvent) or event.change is None or event.process in system.executor_of_task:
        return WITHIN_A_JOB
    return _BEGINS.get(event.change, WITHIN_A_JOB)


def _ends_with_its_step(event: Event) -> bool:
    """Whether a response is where the trace has the last step of its chain: not before, as the start of a job that reads later."""
    if isinstance(event, ProcessEvent | RunnableEvent):
        return event.change in (ProcessChange.TERMINATE, RunnableChange.TERMINATE)
    return True


def measured_events(path: Path, window: MeasurementWindow, begins: ModelBegins) -> Measurement:
    """Measure a trace of events.

    Parameters
    ----------
    begins : with what the jobs and chains of the model begin

    Raises
    ------
    ReadError : the file cannot be read.
    InvalidArgumentError : its format is not known.
    """
    return measured_by(open_trace(path), path, window, begins)


def measured_by(reader: TraceReader, path: Path, window: MeasurementWindow, begins: ModelBegins) -> Measurement:
    """Measure what a reader gives; parameters and errors as for `measured_events`."""
    import numpy as np

    from amalthea_uros.measure.chains import ChainSteps
    from amalthea_uros.measure.jobs import JobFollower
    from amalthea_uros.measure.window import resolution_of

    jobs, chains = JobFollower(begins=begins), ChainSteps(begins.chains, reader.begin_of_chains)
    origin: int | None = None
    times = []
    for table in reader:
        if not len(table):
            continue
        origin = int(table.time[0]) if origin is None else origin
        part = _from(table, origin)
        part = part.where(window.holds(part.time))
        jobs.add(part)
        chains.add(part)
        times.append(np.unique(part.time))
    jobs.finish()
    stamps = np.concatenate([np.empty(0, np.int64), *times])
    names = [entity.name for entity in reader.entities]
    findings = [*reader.findings]
    if jobs.illegal:
        message = f"{jobs.illegal:,} events that the state of their job does not allow; these jobs are not measured"
        findings.append(Finding("MEA004", Severity.WARNING, message, Location(path), "Check the trace for lost events."))
    with paused_garbage_collection():
        series = (*jobs.series(names), *chains.series(names))
    for name in chains.ambiguous:
        message = (
            f"the steps of the chain {name!r} are of several routes, which the trace does not tell apart; it is not measured"
        )
        findings.append(Finding("MEA011", Severity.WARNING, message, Location(path), "Measure it between markers.", name))
    return Measurement(
        source=str(path),
        format=known.name if (known := format_of(path)) is not None else "",
        digest="",
        duration=int(np.ptp(stamps)) if len(stamps) else 0,
        resolution=resolution_of(stamps),
        series=series,
        findings=tuple(findings),
    )


def _from(table: EventTable, first: int) -> EventTable:
    """A table with times from the first event of the trace on."""
    from dataclasses import replace

    return replace(table, time=table.time - first)
