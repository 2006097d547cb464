"""A simulation, and what is measured in its own trace: both sides of a comparison are measured by the same code."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType
from typing import Self

from amalthea_uros.measure.event_chains import ChainSteps
from amalthea_uros.measure.jobs import JobWalk
from amalthea_uros.measure.series import Measurement
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.system import simulate_system
from amalthea_uros.timing.settings import Settings
from amalthea_uros.trace.table import Entity, EventTable
from amalthea_uros.units import Time

#: So many events are measured, which takes about a second; more values would hardly change a distribution.
MOST_EVENTS = 400_000


class _Measuring:
    """A sink that measures the first events of a run; it is its own opener."""

    def __init__(self) -> None:
        self._jobs, self._chains = JobWalk(), ChainSteps()
        self._entities: Sequence[Entity] = ()
        self._end, self._events = 0, 0

    def __call__(self, entities: Sequence[Entity]) -> Self:
        """Open it."""
        self._entities = entities
        return self

    def write(self, table: EventTable) -> None:
        """Measure some events."""
        part = table.rows(0, MOST_EVENTS - self._events)
        if not len(part):
            return
        self._events += len(part)
        self._end = int(part.time[-1])
        self._jobs.add(part)
        self._chains.add(part)

    def close(self) -> None:
        """Nothing is left to do."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        """Keep what was measured for the caller."""

    def measurement(self) -> Measurement:
        """What was measured."""
        self._jobs.finish()
        names = [entity.name for entity in self._entities]
        return Measurement(
            source="simulation",
            format="",
            digest="",
            duration=self._end,
            resolution=None,
            series=(*self._jobs.series(names), *self._chains.series(names)),
        )


def simulate_measured(system: System, settings: Settings, duration: Time, seed: int) -> tuple[Simulation, Measurement]:
    """A run with what is measured in its trace."""
    sink = _Measuring()
    options = Options(duration=duration, seed=seed, settings=settings, traced=(0, duration))
    simulation = simulate_system(system, options, [sink])
    return simulation, sink.measurement()
