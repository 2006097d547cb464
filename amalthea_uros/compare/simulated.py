"""Simulations, and what is measured in their own traces: both sides of a comparison are measured by the same code.

Chains and callbacks of executors that loop begin with events that no trace of a controller has; of these, the simulation keeps values.

If the phase of something from outside is unknown, a single run says nothing about the measured system, which may have any other phase.
Then there is a further, shorter run in each phase, and what they have together is a range.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Self

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.compare.measured.events import begins_of
from amalthea_uros.compare.phases import MOST_PHASES, systems_in_phases
from amalthea_uros.measure.jobs import JobFollower
from amalthea_uros.measure.series import MeasuredKind, Measurement, Series, statistics_or_none
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.metrics.kept_values import KeptValues
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.activation.releases import with_first_arrivals
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.trace.sinks import TraceSink
from amalthea_uros.trace.table import Entity, EventTable
from amalthea_uros.units import SECOND, Duration, Time

#: So many events are measured, which takes about a second; more values would hardly change a distribution.
_MOST_EVENTS = 400_000
#: Further runs are at least so long, unless the first one is shorter.
_SHORTEST = SECOND


@dataclass(frozen=True, slots=True)
class Run:
    """A simulation, with what was measured in its trace."""

    simulation: Simulation
    values: Measurement


class _Measuring(TraceSink):
    """A sink that measures the jobs of the first events of a run; it is its own opener."""

    def __init__(self, system: System, most_events: int) -> None:
        self._most_events = most_events
        self._jobs = JobFollower(begins=begins_of(system))
        self._entities: Sequence[Entity] = ()
        self._end, self._events = 0, 0

    def __call__(self, entities: Sequence[Entity]) -> Self:
        """Open it."""
        self._entities = entities
        return self

    def write(self, table: EventTable) -> None:
        """Measure some events."""
        part = table.rows(0, self._most_events - self._events)
        if not len(part):
            return
        self._events += len(part)
        self._end = int(part.time[-1])
        self._jobs.add(part)

    def measurement(self, kept: KeptValues) -> Measurement:
        """The measured values; of chains and callbacks of executors, as the simulation observes them itself: from the host on."""
        self._jobs.finish()
        names = [entity.name for entity in self._entities]
        calls = [_series(MeasuredKind.RUNNABLE, *each) for each in kept.calls()]
        own = {each.name for each in calls}
        jobs = (each for each in self._jobs.series(names) if each.kind is not MeasuredKind.RUNNABLE or each.name not in own)
        return Measurement(
            source="simulation",
            format="",
            digest="",
            duration=self._end,
            resolution=None,
            series=(*jobs, *calls, *(_series(MeasuredKind.CHAIN, *each) for each in kept.chains())),
        )


def _series(kind: MeasuredKind, name: str, quantity: str, values: Numbers) -> Series:
    return Series(kind=kind, name=name, quantity=quantity, statistics=statistics_or_none(values), values=values)


def simulate_measured(system: System, settings: Settings, duration: Time, seed: int) -> tuple[Run, ...]:
    """A run of a duration, and further ones in other phases if some are unknown."""
    first = _run(system, Options(duration=Duration(duration), seed=seed, settings=settings), _MOST_EVENTS)
    variants = list(_phases(system, settings, seed))
    if not variants:
        return (first,)
    shorter = max(duration // len(variants), min(duration, _SHORTEST))
    events = _MOST_EVENTS // len(variants)
    return (
        first,
        *(_run(each, Options(duration=Duration(shorter), seed=other, settings=settings), events) for each, other in variants),
    )


def _phases(system: System, settings: Settings, seed: int) -> Iterator[tuple[System, int]]:
    """The system in each of its phases, or with other seeds if there are too many; nothing if all phases are known."""
    variants = systems_in_phases(system, settings)
    if variants is None:
        known = with_first_arrivals(system, settings.phases)
        yield from ((known, seed + number) for number in range(1, MOST_PHASES + 1))
    else:
        yield from ((each, seed) for each in variants)


def _run(system: System, options: Options, most_events: int) -> Run:
    sink, kept = _Measuring(system, most_events), KeptValues(most_events)
    simulation = simulate_system(system, replace(options, traced=(0, options.duration)), [sink], kept)
    return Run(simulation, sink.measurement(kept))
