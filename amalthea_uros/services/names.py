"""Names in settings and options, looked up in a system."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import ALL_LABELS
from amalthea_uros.timing.activation.releases import sources
from amalthea_uros.timing.basics.settings import Settings


def require_settings(settings: Settings, system: System) -> None:
    """Refuse settings for what a system does not have; raises as `require`, and TypeError for what is no `Settings`."""
    if not isinstance(settings, Settings):
        raise TypeError(f"expected Settings, not {type(settings).__name__}; changes of values are given as changes=...")
    require("core", settings.frequencies, system.cores)
    require("process", settings.factors, system.processes)
    if settings.phases:
        require("callback with a phase", settings.phases, sources(system))
    require("mode label", settings.modes, [label.name for label in system.software.mode_labels])


def require_labels(names: Iterable[str], system: System) -> None:
    """Refuse labels that a system does not have; raises as `require`."""
    require("label", (name for name in names if name != ALL_LABELS), system.labels)
