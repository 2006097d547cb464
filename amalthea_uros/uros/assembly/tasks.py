"""Tasks and interrupt service routines before their priorities are assigned."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Activity
from amalthea_uros.perf.software import IsrCategory, Preemption
from amalthea_uros.spec.os import OverheadSection
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedTask:
    """A task.

    Attributes
    ----------
    stimuli : names
    period : minimum time between two activations; None if unknown
    priority : as set in the description; None to assign one
    wins_ties : whether it gets a higher priority than other tasks of the same period
    overhead : what the description states for it; `uros.overheads` makes activities of it
    """

    name: str
    core: str
    stimuli: tuple[str, ...]
    activities: tuple[Activity, ...]
    period: Time | None
    priority: int | None = None
    deadline: Time | None = None
    preemption: Preemption = Preemption.PREEMPTIVE
    activation_limit: int = 1
    wins_ties: bool = False
    overhead: OverheadSection | None = None
    origin: Location | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedIsr:
    """An interrupt service routine."""

    name: str
    core: str
    stimuli: tuple[str, ...]
    activities: tuple[Activity, ...]
    priority: int
    category: IsrCategory = IsrCategory.CATEGORY_2
    overhead: OverheadSection | None = None
    origin: Location | None = None
