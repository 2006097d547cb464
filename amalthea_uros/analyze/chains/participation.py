"""Which jobs of the stages of a chain take part in it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.stages import Fire, Stage
from amalthea_uros.timing.jobs.counters import ALWAYS, composed, is_always
from amalthea_uros.timing.jobs.positions import ActivityPosition, can_be_skipped


@dataclass(frozen=True, slots=True)
class Participation:
    """Finds the jobs that take part in groups of stages, each of which is a stage and those that it triggers."""

    context: TimingContext

    def counter(self, stages: Sequence[Stage]) -> Counter:
        """The counter that lets only some jobs of the first stage take part, including those of triggers.

        Raises
        ------
        UnknownError : a stimulus is flawed, or a counter also counts what others activate.
        """
        found = stages[0].counter or ALWAYS
        for stage, then in pairwise(stages):
            assert isinstance(stage.leave, Fire)
            for flaw in filter(None, map(self.context.activations.flaws.of_stimulus, then.process.stimuli)):
                raise UnknownError(flaw)
            fired = stage.leave.position
            if fired is not None and isinstance(fired.activity, Trigger):
                found = composed(found, fired.activity.counter or ALWAYS)
            of_stimuli = [self.counter_of(name) for name in then.process.stimuli]
            others = [counter for counter in (*of_stimuli, then.counter or ALWAYS) if not is_always(counter)]
            if others and not self._is_only_cause(fired, then.process):
                raise UnknownError(f"a counter of {then.process.name!r} also counts activations by others")
            found = reduce(composed, others, found)
        return found

    def counter_of(self, stimulus: str) -> Counter:
        """The counter that lets only some of the triggers of a stimulus have an effect."""
        found = self.context.system.stimuli_by_name.get(stimulus)
        return (found.counter or ALWAYS) if isinstance(found, InterProcess | EventTriggered) else ALWAYS

    def _is_only_cause(self, fired: ActivityPosition | None, triggered: Process) -> bool:
        """Whether each job of a triggered process is activated at one position, which jobs reach once."""
        if fired is None or len(triggered.stimuli) > 1:
            return False
        causes = self.context.dataflow.fired_at(triggered.stimuli[0])
        return len(causes) == 1 and causes[0].times == 1 and causes[0].number == fired.number

    def why_uncertain(self, stages: Sequence[Stage]) -> str:
        """Why it is unknown which jobs take part; "" if it is known."""
        system, modes = self.context.system, self.context.settings.modes
        for stage in stages:
            if stage.counter is None:
                return f"it is unknown which jobs of {stage.process.name!r} take part"
            if any(can_be_skipped(position, system, modes) for position in stage.positions):
                return f"jobs of {stage.process.name!r} can end without the access or event of the chain"
        for stage in stages[1:]:
            if self._has_condition(stage.process):
                return f"a trigger of {stage.process.name!r} has no effect if the condition of its stimulus is false"
        return ""

    def _has_condition(self, process: Process) -> bool:
        stimuli = self.context.system.stimuli_by_name
        return any(stimuli[name].condition is not None for name in process.stimuli if name in stimuli)
