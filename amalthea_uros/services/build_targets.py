"""Models in a form that a tool converts, where it leaves out another one."""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros.diagnostics import Finding
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time

#: The AMALTHEA version in which allocations of tasks have no deadlines.
_WITHOUT_DEADLINES = "1.2.0"


class BuildTarget(StrEnum):
    """A tool that reads models in a way of its own."""

    INCHRON = "inchron"


def system_for(tool: BuildTarget | None, system: System, version: str | None) -> tuple[System, tuple[Finding, ...]]:
    """The system in the form for a tool, with findings about the changes; the system itself without a tool.

    Parameters
    ----------
    version : AMALTHEA version of the model
    """
    if tool is None:
        return system, ()
    from amalthea_uros.inchron_bridge.importable import importable

    return importable(system, iterations_of(system), with_deadlines=version != _WITHOUT_DEADLINES)


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
