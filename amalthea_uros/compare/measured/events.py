"""What the events of a trace measure: of processes, runnables and chains."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import UnknownError
from amalthea_uros.measure.series import Measurement
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.perf.events import Event, ProcessChange, ProcessEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.chains import sequences, unfold
from amalthea_uros.trace.readers import format_of, open_trace
from amalthea_uros.trace.table import EventKind

if TYPE_CHECKING:
    from amalthea_uros.trace.table import EventTable


#: The events of a job with which a chain can begin so that a trace shows it.
_BEGINS = {ProcessChange.ACTIVATE: EventKind.ACTIVATE, ProcessChange.START: EventKind.START}


def chain_starts(system: System) -> dict[str, EventKind | None]:
    """With which event of a job each chain of a system begins; None if it begins or ends at one that traces do not tell apart."""
    found: dict[str, EventKind | None] = {}
    for chain in system.chains.values():
        try:
            routes = [
                (system.events_by_name[way[0]], system.events_by_name[way[-1]]) for way in sequences(unfold(chain, system)[0])
            ]
        except UnknownError:
            continue
        begins = {_begin(first) for first, _ in routes}
        is_shown = len(begins) == 1 and all(_ends_with_its_step(last) for _, last in routes)
        found[chain.name] = begins.pop() if is_shown else None
    return found


def _begin(event: Event) -> EventKind | None:
    return _BEGINS.get(event.change) if isinstance(event, ProcessEvent) and event.change is not None else None


def _ends_with_its_step(event: Event) -> bool:
    """Whether a response is where the trace has the last step of its chain: not before, as the start of a job that reads later."""
    if isinstance(event, ProcessEvent | RunnableEvent):
        return event.change in (ProcessChange.TERMINATE, RunnableChange.TERMINATE)
    return True


def measured_events(path: Path, window: MeasurementWindow, starts: Mapping[str, EventKind | None]) -> Measurement:
    """Measure a trace of events.

    Parameters
    ----------
    starts : of chains that do not begin with the activation of a job: with which event they do; None: they are not measured

    Raises
    ------
    ReadError : the file cannot be read.
    InvalidArgumentError : its format is not known.
    """
    import numpy as np

    from amalthea_uros.measure.chains import ChainSteps
    from amalthea_uros.measure.jobs import JobFollower
    from amalthea_uros.measure.window import resolution_of

    reader = open_trace(path)
    jobs, chains = JobFollower(), ChainSteps(starts)
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
