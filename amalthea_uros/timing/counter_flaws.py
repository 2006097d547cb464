"""Counters without meaning: which times take effect is unknown, and with it what a process does, or when others are activated."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from amalthea_uros.perf.activities import Activity, Call, Trigger, walk
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.stretches import executed


def flaw_of(counter: Counter | None, what: str) -> str:
    """Why the counter of something has no meaning; "" if it has one, or if there is none."""
    if counter is None or counter.prescaler >= 1:
        return ""
    return f"the counter of {what} has the prescaler {counter.prescaler}, which has no meaning"


def flaw_of_activity(activity: Activity) -> str:
    """The same for the counter of an activity."""
    counter = getattr(activity, "counter", None)
    match activity:
        case Call(runnable=name):
            return flaw_of(counter, f"the call of {name!r}")
        case Trigger(stimulus=name):
            return flaw_of(counter, f"the trigger of {name!r}")
    return flaw_of(counter, f"a {type(activity).__name__}")


@dataclass(frozen=True)
class CounterFlaws:
    """The counters of a system that have no meaning."""

    system: System

    def of_process(self, process: Process) -> str:
        """Why it is unknown what the jobs of a process do; "" if it is known. A trigger itself takes no time."""
        return next((flaw for each, flaw in self._in(process) if not isinstance(each, Trigger)), "")

    def of_stimulus(self, name: str) -> str:
        """Why it is unknown when a stimulus activates processes; "" if no counter makes it unknown."""
        return self._of_stimuli.get(name, "")

    @cached_property
    def _of_stimuli(self) -> Mapping[str, str]:
        found: dict[str, str] = {}
        for stimulus in self.system.stimuli.stimuli:
            if isinstance(stimulus, InterProcess | EventTriggered):
                found[stimulus.name] = flaw_of(stimulus.counter, f"the stimulus {stimulus.name!r}")
        for process in self.system.processes.values():
            for activity, flaw in self._in(process):
                if isinstance(activity, Trigger):
                    found[activity.stimulus] = found.get(activity.stimulus) or flaw
        return found

    def _in(self, process: Process) -> Iterator[tuple[Activity, str]]:
        if self._are_any:
            yield from ((each, flaw) for each in executed(process.activities, self.system) if (flaw := flaw_of_activity(each)))

    @cached_property
    def _are_any(self) -> bool:
        return any(flaw_of_activity(activity) for body in self.system.software.bodies for activity in walk(body))
