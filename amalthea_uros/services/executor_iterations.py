"""How often executors in loops iterate, for tools that cannot compute it."""

from __future__ import annotations

from amalthea_uros.perf.system import System
from amalthea_uros.units import Time


def iterations_of(system: System) -> dict[str, tuple[Time, Time]]:
    """The shortest and the longest time between two iterations of executors, by the stimuli that stand for them, where it is bounded.

    These are what the analysis proves; where it proves none, nothing is in the result.
    """
    if not system.executors:
        return {}
    from amalthea_uros.analyze.system import analyze_system

    result: dict[str, tuple[Time, Time]] = {}
    for executor in analyze_system(system).executors:
        least, most = executor.loop.least, executor.loop.most
        if most is not None and least < most:
            result |= dict.fromkeys(system.processes[executor.task].stimuli, (least, most))
    return result
