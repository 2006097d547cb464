"""Whether jobs can go past a position without reaching it: in branches, loops and conditional calls."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.perf.activities import Activity, Call, Count, Loop, ProbabilitySwitch, Switch
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.positions import ActivityPosition
from amalthea_uros.timing.modes import holds


def can_be_skipped(position: ActivityPosition, system: System, modes: Mapping[str, str]) -> bool:
    """Whether a job that a counter lets reach a position may still not reach it.

    Parameters
    ----------
    modes : the known values of mode labels
    """
    *around, (activities, index) = position.outer
    containers = [within[number] for within, number in around]
    return any(_is_optional(each, system, modes) for each in containers) or _is_optional_call(activities[index], system, modes)


def _is_optional(container: Activity, system: System, modes: Mapping[str, str]) -> bool:
    return isinstance(container, Switch | ProbabilitySwitch | Loop) or _is_optional_call(container, system, modes)


def _is_optional_call(activity: Activity, system: System, modes: Mapping[str, str]) -> bool:
    if not isinstance(activity, Call):
        return False
    called = system.runnables.get(activity.runnable)
    is_conditional = called is not None and called.condition is not None and not holds(called.condition, modes)
    return is_conditional or (activity.times is not None and _least(activity.times) < 1)


def _least(times: Count | float) -> float:
    return times.least if isinstance(times, Count) else times
