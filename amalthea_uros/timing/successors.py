"""Processes and those that they trigger."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.links import Dataflow


def with_successors(processes: Iterable[str], system: System, dataflow: Dataflow) -> frozenset[str]:
    """Some processes, and those that they trigger, directly or by others."""
    found = set[str]()
    reached = [name for name in processes if name in system.processes]
    while reached:
        name = reached.pop()
        if name in found:
            continue
        found.add(name)
        stimuli = _triggered(name, system, dataflow)
        reached += [other.name for other in system.processes.values() if not stimuli.isdisjoint(other.stimuli)]
    return frozenset(found)


def _triggered(name: str, system: System, dataflow: Dataflow) -> frozenset[str]:
    """The stimuli that the jobs of a process trigger."""
    try:
        positions = dataflow.events.positions(name)
    except UnknownError:
        return frozenset(stimulus.name for stimulus in system.stimuli.stimuli if isinstance(stimulus, InterProcess))
    return frozenset(position.activity.stimulus for position in positions if isinstance(position.activity, Trigger))
