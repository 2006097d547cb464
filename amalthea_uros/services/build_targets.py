"""Models in a form that a tool converts, where it leaves out another one."""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros.diagnostics import Finding
from amalthea_uros.perf.system import System

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
    from amalthea_uros.services.executor_iterations import iterations_of

    return importable(system, iterations_of(system), with_deadlines=version != _WITHOUT_DEADLINES)
