"""The schedules of the cores of a system, each computed once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from amalthea_uros.analyze.chains.completed_work import Busy
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.core import periodic_tasks
from amalthea_uros.analyze.response_times.schedule import Jobs, PeriodicTask
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class CoreSchedule:
    """The schedules of a core for all worst and all best cases.

    The last of the cycles that are covered is the steady state.

    Attributes
    ----------
    has_idle_time : whether the core is idle in each cycle of the worst cases, which then ends what came before: whatever it was, the
        worst cases lead to the same steady state
    """

    tasks: Mapping[str, PeriodicTask]
    worst: Mapping[str, Jobs]
    best: Mapping[str, Jobs]
    steady_state_start: Time
    cycle: Time
    has_idle_time: bool

    @property
    def until(self) -> Time:
        """The end of the covered time; its last cycle repeats."""
        return self.steady_state_start + self.cycle

    def busy_above(self, name: str) -> Busy:
        """When the core executes tasks of higher priority than one of them, in the worst case."""
        priority = self.tasks[name].priority
        above = [self.worst[task.name] for task in self.tasks.values() if task.priority > priority]
        return Busy.of(above, self.cycle, self.until)


@dataclass(slots=True)
class CoreSchedules:
    """The schedules of all cores."""

    solution: Solution
    _found: dict[tuple[str, bool], CoreSchedule | None] = field(default_factory=dict)

    def of(self, core: str, with_slices: bool) -> CoreSchedule | None:
        """The schedule of a core; None if it is unknown or too long.

        Parameters
        ----------
        with_slices : whether the execution slices of jobs are needed
        """
        # One with slices serves for both.
        key = (core, with_slices or (core, True) in self._found)
        if key not in self._found:
            self._found[key] = self._new(core, with_slices)
        return self._found[key]

    def _new(self, core: str, with_slices: bool) -> CoreSchedule | None:
        tasks = periodic_tasks(core, self.solution)
        if not tasks:
            return None
        found = self.solution.schedule(core, tasks, with_slices)
        if found is None:
            return None
        cycle, names = schedule.hyperperiod(tasks), [task.name for task in tasks]
        return CoreSchedule(
            tasks=dict(zip(names, tasks, strict=True)),
            worst=dict(zip(names, found.worst, strict=True)),
            best=dict(zip(names, found.best, strict=True)),
            steady_state_start=schedule.steady_state_start(tasks) + cycle,
            cycle=cycle,
            has_idle_time=sum((task.demand.mean_worst / task.period for task in tasks), Fraction(0)) < 1,
        )
