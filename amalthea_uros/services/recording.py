"""The events of a part of a simulation, kept in memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from types import TracebackType
from typing import TYPE_CHECKING, Self

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.units import Time, time_text

if TYPE_CHECKING:
    from amalthea_uros.trace.table import Entity, EventTable


@dataclass(slots=True)
class _Recorder:
    """A sink that keeps all events."""

    tables: list[EventTable] = field(default_factory=list)

    def __call__(self, _entities: Sequence[Entity]) -> Self:
        return self

    def write(self, table: EventTable) -> None:
        """Keep some events."""
        self.tables.append(table)

    def close(self) -> None:
        """Nothing is left to do."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        """Keep the events for the caller."""


def record_events(result: SimulationResult, start: Time, end: Time) -> EventTable:
    """The events of a part of a simulation, which is repeated up to there: runs with the same options are equal.

    Raises
    ------
    InvalidArgumentError : nothing happens in the window.
    """
    from amalthea_uros.simulate.system import simulate_system
    from amalthea_uros.trace.table import concatenate

    end = min(end, result.options.duration)
    recorder = _Recorder()
    simulate_system(result.system, replace(result.options, duration=end, traced=(start, end)), [recorder])
    if not any(map(len, recorder.tables)):
        raise InvalidArgumentError(f"nothing happens from {time_text(start)} to {time_text(end)}; choose another window")
    return concatenate(recorder.tables)
