"""Whether jobs can go past a position without reaching it: in branches, loops, conditional calls, and accesses that need not occur."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.perf.activities import Activity, Call, LabelAccess, Loop, ProbabilitySwitch, Switch
from amalthea_uros.perf.system import System
from amalthea_uros.timing.counts import bounds_of
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
    return any(_is_optional(each, system, modes) for each in containers) or _need_not_occur(activities[index], system, modes)


def _is_optional(container: Activity, system: System, modes: Mapping[str, str]) -> bool:
    return isinstance(container, Switch | ProbabilitySwitch | Loop) or _need_not_occur(container, system, modes)


def _need_not_occur(activity: Activity, system: System, modes: Mapping[str, str]) -> bool:
    if not isinstance(activity, Call | LabelAccess):
        return False
    least, _ = bounds_of(activity.times)
    if least < 1 or isinstance(activity, LabelAccess):
        return least < 1
    called = system.runnables.get(activity.runnable)
    return called is not None and called.condition is not None and not holds(called.condition, modes)
