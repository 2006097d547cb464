"""Pictures of simulations as SVG: Gantt charts, states of a process, histograms."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import ceil, floor
from typing import TypeAlias

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.report.pictures.from_events import jobs_of
from amalthea_uros.report.pictures.gantt import GanttChart, gantt
from amalthea_uros.report.pictures.histogram import Histogram, Series, histogram
from amalthea_uros.report.pictures.histogram_marks import Mark, MarkKind
from amalthea_uros.report.pictures.jobs import ProcessRow
from amalthea_uros.report.pictures.state_timeline import StateTimeline, state_timeline
from amalthea_uros.report.pictures.windows import default_window
from amalthea_uros.services.names import require
from amalthea_uros.services.recording import record_events
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate import results
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.results import ChainQuantity, MetricObservation, ProcessObservation
from amalthea_uros.timing.job_metric import JobMetric
from amalthea_uros.units import Time, time_text

Window: TypeAlias = tuple[Time, Time]


def gantt_picture(result: SimulationResult, window: Window | None) -> str:
    """All processes in a window; None: around the job that comes closest to its deadline, or responds last."""
    start, end = window or _window_around(min(_with_jobs(result), key=_distance))
    rows = jobs_of(record_events(result, start, end), start, end, _deadlines(result))
    return gantt(GanttChart("Simulation", start, end, rows))


def timeline_picture(result: SimulationResult, process: str, window: Window | None) -> str:
    """The states of a process in a window; None: around its job with the longest response time."""
    start, end = window or _window_around(result.simulation.processes[process])
    cores = jobs_of(record_events(result, start, end), start, end, _deadlines(result))
    rows = {row.name: row for core in cores for row in core.rows}
    return state_timeline(StateTimeline(f"States of {process}", start, end, rows.get(process, ProcessRow(process, ()))))


def check_window_of(options: Options, window: Window) -> None:
    """InvalidArgumentError if a window is after the end of the run."""
    if window[0] >= options.duration:
        start, end = time_text(window[0]), time_text(options.duration)
        raise InvalidArgumentError(f"the window starts at {start}, but the run ends at {end}")


def quantity_of(name: str, system: System) -> tuple[str, str]:
    """The process or chain and the quantity that a name stands for.

    Parameters
    ----------
    name : of a process or chain, or of one of its quantities such as "Task.start_to_start"; by default, the response time or the
        reduced reaction time

    Raises
    ------
    InvalidArgumentError : there is no such process or chain, or it has no such quantity.
    """
    if name in system.processes:
        return name, JobMetric.RESPONSE_TIME
    if name in system.chains:
        return name, ChainQuantity.REDUCED_REACTION_TIME
    of, _, quantity = name.rpartition(".")
    require("process or chain", [of or name], dict.fromkeys((*system.processes, *system.chains)))
    require("quantity", [quantity], JobMetric if of in system.processes else ChainQuantity)
    return of, quantity


def histogram_picture(result: SimulationResult, name: str) -> str:
    """The values of a metric or of a latency; `name` as for `quantity_of`.

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
    return _histogram_of(result, of, quantity, observed[quantity])


def _histogram_of(result: SimulationResult, name: str, quantity: str, observed: MetricObservation) -> str:
    assert observed.histogram is not None
    edges, counts = _whole_bins(observed.histogram)
    words = quantity.replace("_", " ")
    marks = [Mark("min", observed.min), Mark("mean", observed.mean), Mark("max", observed.max)]
    deadline = _deadlines(result).get(name) if quantity == JobMetric.RESPONSE_TIME else None
    if deadline is not None:
        marks.append(Mark("deadline", deadline, MarkKind.LIMIT))
    things = "jobs" if quantity in tuple(JobMetric) else "observations"
    chart = Histogram(f"{words.capitalize()} of {name}", edges, (Series("simulated", counts),), tuple(marks), words, things)
    return histogram(chart)


def _whole_bins(found: results.Histogram) -> tuple[tuple[Time, ...], tuple[int, ...]]:
    """Edges in whole picoseconds, which rise: narrower bins are taken together."""
    size = ceil(1 / found.width)
    counts = tuple(sum(found.counts[first : first + size]) for first in range(0, len(found.counts), size))
    return tuple(floor(found.start + number * size * found.width) for number in range(len(counts) + 1)), counts


def _deadlines(result: SimulationResult) -> dict[str, Time]:
    return {each.name: each.deadline for each in result.simulation.processes if each.deadline is not None}


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


def _window_around(process: ProcessObservation) -> Window:
    response = process.response_time
    if response is None:
        raise InvalidArgumentError(f"no job of {process.name!r} ended in the run; say with --window FROM..TO what to show")
    activation = response.at_max.time
    return default_window(floor(activation), ceil(activation + response.max))
