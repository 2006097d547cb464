"""The events of a part of a simulation, kept in memory."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.units import Time, time_text

if TYPE_CHECKING:
    from amalthea_uros.trace.table import EventTable


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
    simulate_system(result.system, replace(result.options, duration=end, traced=(start, end)), [recorder])
    return recorder.table
