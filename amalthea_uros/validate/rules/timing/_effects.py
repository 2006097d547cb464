"""What takes the effect from one event of a chain to the next.

That is the order within a job, data that one process writes and another one reads, or that one makes the other one run, or go on.
"""

from __future__ import annotations

from itertools import product

from amalthea_uros.metamodel.classes import Event, EventStimulus, IExecutable, Process, Stimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executions
from amalthea_uros.validate.rules.timing._deeds import Deeds, read, written
from amalthea_uros.validate.rules.timing._moments import ACTIVATION, Moments, Spot

#: With more places where both events may occur it is not asked whether something carries the effect.
_MOST_PAIRS = 10_000


class Effects:
    """What carries effects in a model; what is asked for is found once."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._moments = context.once(Moments)
        self._deeds: dict[IExecutable, Deeds] = {}
        self._jobs: dict[Process, Deeds] = {}

    def is_carried(self, first: Event, then: Event) -> bool:
        """Whether something takes the effect from one event to another one; also if it is not known where they occur."""
        starts, ends = self._moments.of(first), self._moments.of(then)
        if not starts or not ends or len(starts) * len(ends) > _MOST_PAIRS:
            return True
        return any(self._carries(start, end) for start, end in product(starts, ends))

    def _carries(self, start: Spot, end: Spot) -> bool:
        if start.process is end.process:
            return start.first <= end.last or self._is_read(start, end)
        # Of two activations neither is the cause of the other one: it takes a job to trigger something.
        is_cause = start.first > ACTIVATION or end.first > ACTIVATION
        return (is_cause and self._makes_run(start.process, end.process)) or self._is_read(start, end)

    def _is_read(self, start: Spot, end: Spot) -> bool:
        """Whether data that are written where the one event occurs are read where the other one does.

        That is by the item itself, else in its runnable, else anywhere in the job.
        """
        sources = set(written(start.item)) or self._own(start.home).written or self._job(start.process).written
        targets = set(read(end.item)) or self._own(end.home).read or self._job(end.process).read
        return not sources.isdisjoint(targets)

    def _makes_run(self, cause: Process, effect: Process) -> bool:
        """Whether a process activates another one, lets it go on, or gives it a result or gets one from it."""
        mine, others = self._job(cause), self._job(effect)
        return (
            any(stimulus in mine.triggered or self._fires(cause, stimulus) for stimulus in effect.stimuli)
            or any((event, target) in mine.signalled for event in others.awaited for target in (None, effect))
            or any(effect in executions(self._context).get(runnable, ()) for runnable in mine.served)
            or any(cause in executions(self._context).get(runnable, ()) for runnable in others.served)
        )

    def _fires(self, cause: Process, stimulus: Stimulus) -> bool:
        """Whether an event to which a stimulus reacts occurs in a process."""
        events = stimulus.triggering_events if isinstance(stimulus, EventStimulus) else ()
        return any(spot.process is cause for event in events for spot in self._moments.of(event))

    def _own(self, executable: IExecutable | None) -> Deeds:
        """What a process or runnable does itself."""
        if executable is None:
            return _NOTHING
        if executable not in self._deeds:
            self._deeds[executable] = Deeds.of(executable)
        return self._deeds[executable]

    def _job(self, process: Process) -> Deeds:
        """What is done in the jobs of a process."""
        if process not in self._jobs:
            self._jobs[process] = Deeds()
            for executable in self._moments.starts(process):
                self._jobs[process].add(self._own(executable))
        return self._jobs[process]


_NOTHING = Deeds()
