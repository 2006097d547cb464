"""Processes that a job of another one triggers on paths that exclude each other: together, they take as long as the longest path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.timing.activation import Activations
from amalthea_uros.timing.job_paths import most_in_a_job
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class TriggeredTogether:
    """Processes of which each job of another process triggers some, each once at most, and nothing else triggers them.

    Attributes
    ----------
    cause : the process that triggers them
    numbers : by their names, those of the activities that do
    """

    cause: str
    numbers: Mapping[str, Sequence[int]]

    def longest(self, demands: Mapping[str, Time], activations: Activations, modes: Mapping[str, str]) -> Time:
        """What those that one job triggers demand together at most.

        Parameters
        ----------
        demands : of those that count
        """
        triggered: dict[int, Time] = {}
        for name, demand in demands.items():
            for number in self.numbers.get(name, ()):
                triggered[number] = triggered.get(number, 0) + demand
        positions = activations.dataflow.events.positions(self.cause)
        return most_in_a_job(positions, dict(sorted(triggered.items())), modes)


def triggered_together(activations: Activations) -> list[TriggeredTogether]:
    """All processes that others trigger in this way."""
    found: dict[str, dict[str, list[int]]] = {}
    system = activations.system
    for process in system.processes.values():
        stimulus = system.stimuli_by_name.get(process.stimuli[0]) if len(process.stimuli) == 1 else None
        if not isinstance(stimulus, InterProcess) or stimulus.counter is not None:
            continue
        causes = activations.causes(stimulus)
        triggering = {cause.process.name for cause in causes}
        if len(triggering) == 1 and all(cause.is_each_time for cause in causes) and activations.most_in_a_job(causes) == 1:
            numbers = [cause.position.number for cause in causes]
            found.setdefault(min(triggering), {})[process.name] = numbers
    return [TriggeredTogether(cause, numbers) for cause, numbers in found.items() if len(numbers) > 1]
