"""Pictures of simulations as SVG: Gantt charts, states of a process, histograms."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import ceil, floor
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.report.pictures.axes import default_window
from amalthea_uros.report.pictures.chain_paths import DrawnPath
from amalthea_uros.report.pictures.from_events import chain_path, jobs_of
from amalthea_uros.report.pictures.gantt import GanttChart, StateTimeline, gantt, state_timeline
from amalthea_uros.report.pictures.histogram import HistogramPicture, Mark, MarkKind, histogram
from amalthea_uros.report.pictures.jobs import CoreRows, ProcessRow
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate.observations import (
    WITH_HISTOGRAM,
    ChainObservation,
    MetricObservation,
    ObservedOccurrence,
    ProcessObservation,
)
from amalthea_uros.simulate.options import Options
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.timing.basics.stated_times import KeptTime
from amalthea_uros.trace.table import Entity, EntityKind, EventKind
from amalthea_uros.units import Time, time_text

if TYPE_CHECKING:
    from amalthea_uros.trace.table import EventTable

Window: TypeAlias = tuple[Time, Time]


@dataclass(frozen=True, slots=True)
class _View:
    """A part of a run.

    Attributes
    ----------
    process : the one that it is about; "" for a chain or a window of the user
    way : what it shows beside the jobs: a chain, its stimulus, and from when to when the latency is
    """

    title: str
    window: Window
    process: str = ""
    way: tuple[str, ObservedOccurrence, Time, Time] | None = None


def gantt_picture(
    result: SimulationResult,
    *,
    window: Window | None = None,
    process: str | None = None,
    chain: str | None = None,
    most_rows: int | None = None,
) -> str:
    """All processes in a part of the run.

    Parameters
    ----------
    window : the part; None: around the job that comes closest to its deadline, or responds last
    process : the part around its longest response time
    chain : the part around its longest reduced reaction time, with the way of the effect through the jobs
    most_rows : of more processes, only so many are shown: those of the way first, then those with most of the executed jobs

    Raises
    ------
    InvalidArgumentError : nothing was observed, or nothing happens there.
    """
    view = _view(result, window, process, chain)
    start, end = view.window
    events = record_events(result, start, end)
    ways = () if view.way is None else (_way(events, *view.way),)
    rows = jobs_of(events, start, end, _deadlines(result), _cores(result))
    number = sum(len(core.rows) for core in rows)
    title = view.title
    if most_rows is not None and number > most_rows:
        title = f"{title} ({most_rows} of {number:,} processes)"
        rows = _most_important(rows, [view.process, *(step.process for way in ways for step in way.steps)], most_rows)
    return gantt(GanttChart(_titled(result, title), start, end, rows, ways))


def _most_important(cores: Sequence[CoreRows], names: Sequence[str], most: int) -> tuple[CoreRows, ...]:
    """The rows of some processes, and of those with most of the jobs."""
    rows = sorted((row for core in cores for row in core.rows), key=lambda row: (row.name not in names, -len(row.jobs)))
    kept = {row.name for row in rows[:most]}
    found = (replace(core, rows=tuple(row for row in core.rows if row.name in kept)) for core in cores)
    return tuple(core for core in found if core.rows)


def timeline_picture(result: SimulationResult, process: str, window: Window | None) -> str:
    """The states of a process in a window; None: around its job with the longest response time."""
    start, end = window or _longest_response(result.simulation.processes[process]).window
    cores = jobs_of(record_events(result, start, end), start, end, _deadlines(result))
    rows = {row.name: row for core in cores for row in core.rows}
    title = _titled(result, f"states of {process}")
    return state_timeline(StateTimeline(title, start, end, rows.get(process, ProcessRow(process, ()))))


def _titled(result: SimulationResult, title: str) -> str:
    """A title with the names of the files; a system of the library has none."""
    files = ", ".join(path.name for path in result.paths)
    return f"{files}: {title}" if files else title


def _view(result: SimulationResult, window: Window | None, process: str | None, chain: str | None) -> _View:
    if chain is not None:
        return _longest_latency(result.simulation.chains[chain])
    if process is not None:
        return _longest_response(result.simulation.processes[process])
    if window is not None:
        return _View("part of a run", window)
    return _longest_response(min(_with_jobs(result), key=_distance))


def _longest_response(process: ProcessObservation) -> _View:
    response = process.response_time
    if response is None:
        raise InvalidArgumentError(f"no job of {process.name!r} ended in the run; say with --window FROM..TO what to show")
    start, end = _whole(response)
    return _View(f"longest response time of {process.name}", default_window(start, end), process.name)


def _longest_latency(chain: ChainObservation) -> _View:
    latency = chain.quantities.get(ChainQuantity.REDUCED_REACTION_TIME)
    if latency is None:
        reason = chain.reason or "simulate for longer with --duration TIME"
        raise InvalidArgumentError(f"no response of the chain {chain.name!r} was observed in the run: {reason}")
    start, end = _whole(latency)
    title = f"longest reduced reaction time of {chain.name}"
    return _View(title, default_window(start, end), way=(chain.name, latency.at_max, start, end))


def _whole(observed: MetricObservation) -> Window:
    """From when to when the greatest value is, in whole picoseconds."""
    return floor(observed.at_max.time), ceil(observed.at_max.time + observed.max)


def _way(events: EventTable, chain: str, stimulus: ObservedOccurrence, start: Time, end: Time) -> DrawnPath:
    """The way of what is the response to a stimulus of a chain: of this stimulus, or of a newer one that overtakes it."""
    is_step = (events.kind == EventKind.CHAIN_STEP) & (events.target_instance >= stimulus.instance)
    is_step &= np.array([entity == Entity(EntityKind.CHAIN, chain) for entity in events.entities])[events.target]
    steps = events.where(is_step)
    last = steps.where(steps.note == steps.note.max(initial=0))
    way = chain_path(steps, chain, int(last.target_instance[0])) if len(last) else DrawnPath(chain, ())
    return replace(way, start=start, end=end)


def check_window_of(options: Options, window: Window) -> None:
    """InvalidArgumentError if a window is after the end of the run."""
    if window[0] >= options.duration:
        start, end = time_text(window[0]), time_text(options.duration)
        raise InvalidArgumentError(f"the window starts at {start}, but the run ends at {end}")


def quantity_of(name: str, system: System) -> tuple[str, str]:
    """The process or chain and the quantity that a name stands for.

    Parameters
    ----------
    name : of a process or chain, or of one of its quantities such as "Task.net_execution_time"; by default, the response time or the
        reduced reaction time

    Raises
    ------
    InvalidArgumentError : there is no such process or chain, or no histogram is kept of such a quantity.
    """
    if name in system.processes:
        return name, JobMetric.RESPONSE_TIME
    if name in system.chains:
        return name, ChainQuantity.REDUCED_REACTION_TIME
    of, _, quantity = name.rpartition(".")
    require("process or chain", [of or name], dict.fromkeys((*system.processes, *system.chains)))
    require("quantity with a histogram", [quantity], WITH_HISTOGRAM if of in system.processes else ChainQuantity)
    return of, quantity


def histogram_picture(result: SimulationResult, name: str, more: Iterable[Mark] = ()) -> str:
    """The values of a metric or of a latency; `name` as for `quantity_of`.

    Parameters
    ----------
    more : marks besides those of what was observed, and of the deadline

    Raises
    ------
    InvalidArgumentError : as for `quantity_of`, or there is no histogram of the quantity.
    """
    of, quantity = quantity_of(name, result.system)
    observed: dict[str, MetricObservation] = {}
    for process in (each for each in result.simulation.processes if each.name == of):
        observed |= {str(metric): found for metric, found in process.metrics.items()}
    for chain in (each for each in result.simulation.chains if each.name == of):
        observed |= {str(each): found for each, found in chain.quantities.items()}
    kept = [each for each, found in observed.items() if found.histogram is not None]
    if quantity not in kept:
        advice = f"there are those of {', '.join(kept)}" if kept else "nothing of it was observed"
        raise InvalidArgumentError(f"there is no histogram of {quantity} of {of!r}; {advice}")
    return _histogram_of(result, of, quantity, observed[quantity], more)


def _histogram_of(result: SimulationResult, name: str, quantity: str, observed: MetricObservation, more: Iterable[Mark]) -> str:
    assert observed.histogram is not None
    # Bins are a whole number of picoseconds wide.
    edges = tuple(map(int, observed.histogram.edges))
    words = quantity.replace("_", " ")
    marks = [Mark("min", observed.min), Mark("mean", observed.mean), Mark("max", observed.max)]
    deadline = _deadlines(result).get(name) if quantity == JobMetric.RESPONSE_TIME else None
    if deadline is not None:
        marks.append(Mark("deadline", deadline, MarkKind.LIMIT))
    marks += more
    things = "jobs" if quantity in tuple(JobMetric) else "observations"
    title = _titled(result, f"{words} of {name}")
    chart = HistogramPicture(title, edges, "simulated", observed.histogram.counts, tuple(marks), words, things)
    return histogram(chart)


def _deadlines(result: SimulationResult) -> dict[str, Time]:
    return {each.name: each.deadline for each in result.simulation.processes if each.deadline is not None}


def _cores(result: SimulationResult) -> dict[str, str]:
    """Of the processes that can run on one only: a short window may begin and end before they start."""
    return {each.name: each.core for each in result.simulation.processes if each.core is not None}


def _with_jobs(result: SimulationResult) -> Iterable[ProcessObservation]:
    found = [each for each in result.simulation.processes if each.response_time is not None]
    if not found:
        raise InvalidArgumentError("no job ended in the run; say with --window FROM..TO what the picture is to show")
    return found


def _distance(process: ProcessObservation) -> tuple[bool, Fraction]:
    """How close a process came to its deadline; those without one come last, the longest response time first."""
    if process.margin is not None:
        return False, process.margin
    return True, -process.response_time.max if process.response_time is not None else Fraction(0)


def record_events(result: SimulationResult, start: Time, end: Time) -> EventTable:
    """The events of a part of a simulation. If they were not kept, it is repeated up to there: runs with the same options are equal.

    Raises
    ------
    InvalidArgumentError : nothing happens in the window.
    """
    end = min(end, result.options.duration)
    kept = result.simulation.trace
    events = _repeated(result, start, end) if kept is None else kept.between(start, end)
    if not len(events):
        raise InvalidArgumentError(f"nothing happens from {time_text(start)} to {time_text(end)}; choose another window")
    return events


def _repeated(result: SimulationResult, start: Time, end: Time) -> EventTable:
    from amalthea_uros.simulate.runs.run import simulate_system
    from amalthea_uros.trace.sinks import EventRecorder

    recorder = EventRecorder()
    simulate_system(
        result.system, replace(result.options, duration=KeptTime(end), traced=(KeptTime(start), KeptTime(end))), [recorder]
    )
    return recorder.table
