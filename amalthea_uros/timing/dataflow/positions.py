"""Where in a process something is done: behind which other activities, and in which jobs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from amalthea_uros.perf.software import Activity, Call, Group, Loop, ProbabilitySwitch, Process, Switch
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.perf.system import System


@dataclass(frozen=True, slots=True)
class Place:
    """An activity in the jobs of a process.

    Attributes
    ----------
    number : order in which a job comes to it
    last : the number of the last activity within it, its own if there is none
    runnable : in which it stands; None: directly in the process
    outer : the lists of activities in which it stands, from the process inwards, each with its position in it
    counters : those that let only some jobs come here
    is_certain : whether each job comes here at the same point, but for the counters
    """

    process: Process
    number: int
    last: int
    activity: Activity
    runnable: str | None
    outer: tuple[tuple[tuple[Activity, ...], int], ...]
    counters: tuple[Counter, ...]
    is_certain: bool

    @property
    def before(self) -> tuple[Activity, ...]:
        """What a job has done when it comes here."""
        return tuple(activity for activities, index in self.outer for activity in activities[:index])


def places(process: Process, system: System) -> list[Place]:
    """Everything that the jobs of a process do, in order."""
    found = list(_Walk(process, system).within(process.activities, None, (), (), True))
    # What is within something stands deeper, and follows it at once.
    open_places: list[int] = []
    for index, place in enumerate((*found, None)):
        while open_places and (place is None or len(found[open_places[-1]].outer) >= len(place.outer)):
            closed = open_places.pop()
            found[closed] = replace(found[closed], last=found[index - 1].number)
        open_places.append(index)
    return found


@dataclass(slots=True)
class _Walk:
    process: Process
    system: System
    number: int = 0
    above: tuple[str, ...] = ()

    def within(
        self,
        activities: tuple[Activity, ...],
        runnable: str | None,
        outer: tuple[tuple[tuple[Activity, ...], int], ...],
        counters: tuple[Counter, ...],
        is_certain: bool,
    ) -> Iterator[Place]:
        for index, activity in enumerate(activities):
            here = (*outer, (activities, index))
            counted = counters
            if isinstance(activity, Call) and activity.counter is not None:
                counted = (*counters, activity.counter)
            self.number += 1
            yield Place(self.process, self.number, self.number, activity, runnable, here, counted, is_certain)
            match activity:
                case Call(runnable=name) if name in self.system.runnables and name not in self.above:
                    called, self.above = self.system.runnables[name], (*self.above, name)
                    certain = is_certain and activity.times is None and called.condition is None
                    yield from self.within(called.activities, name, here, counted, certain)
                    self.above = self.above[:-1]
                case Group(activities=inner, ordered=ordered):
                    yield from self.within(inner, runnable, here, counted, is_certain and ordered)
                case Loop(activities=inner):
                    yield from self.within(inner, runnable, here, counted, False)
                case ProbabilitySwitch(branches=branches):
                    for branch in branches:
                        yield from self.within(branch.activities, runnable, here, counted, False)
                case Switch(cases=cases, default=default):
                    for inner in (*(case.activities for case in cases), default or ()):
                        yield from self.within(inner, runnable, here, counted, False)
