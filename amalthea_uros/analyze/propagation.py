"""Activations that spread through a system: a process that another one triggers arrives as irregularly as that one ends.

Compositional analysis (K. Richter 2005): the arrivals of the triggered process are derived from those of the triggering one and the
times at which the jobs of its busy window end. This is repeated until nothing changes; irregularity only grows, so that the least fixed
point is found, or none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from amalthea_uros.analyze.activation import arrivals_of
from amalthea_uros.analyze.arrivals import Arrivals, Behind, Delayed, Every, Together
from amalthea_uros.analyze.task import Response
from amalthea_uros.perf.software import Activity, Call, Process, Trigger, walk
from amalthea_uros.perf.stimuli import Counter, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time


class UnknownArrivalsError(Exception):
    """Nothing bounds the arrivals of a process; the text says why."""


@dataclass(slots=True)
class Propagation:
    """The arrivals of all processes, given their response times so far.

    Attributes
    ----------
    least_costs : best-case execution times, as far as they are known
    triggers : who triggers a stimulus
    """

    system: System
    least_costs: Mapping[str, Time]
    triggers: dict[str, list[tuple[Process, Counter | None]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for process in self.system.processes.values():
            for trigger in self._triggers(process.activities, ()):
                self.triggers.setdefault(trigger.stimulus, []).append((process, trigger.counter))

    def _triggers(self, activities: tuple[Activity, ...], above: tuple[str, ...]) -> Iterator[Trigger]:
        for activity in walk(activities):
            if isinstance(activity, Trigger):
                yield activity
            elif isinstance(activity, Call) and activity.runnable not in above:
                runnable = self.system.runnables.get(activity.runnable)
                if runnable is not None:
                    yield from self._triggers(runnable.activities, (*above, activity.runnable))

    def arrivals(self, process: Process, responses: Mapping[str, Response], above: tuple[str, ...] = ()) -> Arrivals:
        """The event model of a process.

        Raises
        ------
        UnknownArrivalsError : it is never activated, or nothing bounds how often.
        """
        if process.name in above:
            raise UnknownArrivalsError(f"it is triggered in a circle: {' -> '.join((*above, process.name))}")
        found = [self._of(name, responses, (*above, process.name)) for name in process.stimuli]
        if not found:
            raise UnknownArrivalsError("it has no stimulus, so that nothing activates it")
        return found[0] if len(found) == 1 else Together(tuple(found))

    def _of(self, name: str, responses: Mapping[str, Response], above: tuple[str, ...]) -> Arrivals:
        stimulus = self.system.stimuli_by_name.get(name)
        if stimulus is None:
            raise UnknownArrivalsError(f"the stimulus {name!r} is not part of the model")
        if not isinstance(stimulus, InterProcess):
            arrivals = arrivals_of(stimulus)
            if arrivals is None:
                raise UnknownArrivalsError(f"nothing bounds how often {name!r} occurs")
            return arrivals
        sources = [self._behind(process, counter, responses, above) for process, counter in self.triggers.get(name, ())]
        if not sources:
            raise UnknownArrivalsError(f"nothing triggers {name!r}")
        together = sources[0] if len(sources) == 1 else Together(tuple(sources))
        return _counted(together, stimulus.counter)

    def _behind(
        self, process: Process, counter: Counter | None, responses: Mapping[str, Response], above: tuple[str, ...]
    ) -> Arrivals:
        """The arrivals that a process causes somewhere between its start and its end."""
        before = self.arrivals(process, responses, above)
        response = responses.get(process.name)
        if response is None:
            return _counted(before, counter)
        if response.worst is None:
            raise UnknownArrivalsError(f"{process.name!r}, which triggers it, has no bounded response time")
        return _counted(behind(before, response, self.least_costs.get(process.name, 0)), counter)


def behind(arrivals: Arrivals, response: Response, least_cost: Time) -> Arrivals:
    """The ends of the jobs of a task as arrivals; each of them costs something at least."""
    if response.completions:
        return Behind(arrivals, response.completions, least_cost)
    return Delayed(arrivals, (response.worst or 0) - least_cost)


def _counted(arrivals: Arrivals, counter: Counter | None) -> Arrivals:
    return Every(arrivals, counter.prescaler) if counter is not None and counter.prescaler > 1 else arrivals
