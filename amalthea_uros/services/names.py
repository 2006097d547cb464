"""Names that callers give, looked up in what was read."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import ALL_LABELS
from amalthea_uros.timing.phases import sources
from amalthea_uros.timing.settings import Settings

#: Longer lists of names are cut.
_MOST_NAMES = 20


def require(kind: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Refuse a name that is not known.

    Raises
    ------
    InvalidArgumentError : says what the name may mean, or which names there are.
    """
    existing = list(known)
    for name in names:
        if name not in existing:
            raise InvalidArgumentError(f"unknown {kind} {name!r}; {_advice(kind, name, existing)}")


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


def _advice(kind: str, name: str, existing: list[str]) -> str:
    if not existing:
        return f"the model has no {kind}"
    return did_you_mean(name, existing) or f"known: {listed(existing)}"


def listed(names: list[str]) -> str:
    """Names as a list, which is cut if it is long."""
    rest = len(names) - _MOST_NAMES
    return ", ".join(names[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else "")
