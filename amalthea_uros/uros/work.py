"""What comes together while a system is assembled."""

from __future__ import annotations

from dataclasses import dataclass, field

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.software import Runnable
from amalthea_uros.spec.description import Description
from amalthea_uros.uros.demand import Profile
from amalthea_uros.uros.hardware import Controller
from amalthea_uros.uros.notes import Notes
from amalthea_uros.uros.stimuli import StimulusPool
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask


@dataclass(slots=True, kw_only=True)
class Work:
    """A description, and what has come of it so far.

    Attributes
    ----------
    runnables : by name, in the order in which they came up
    """

    description: Description
    controller: Controller
    notes: Notes
    pool: StimulusPool = field(default_factory=StimulusPool)
    tasks: list[PlannedTask] = field(default_factory=list)
    isrs: list[PlannedIsr] = field(default_factory=list)
    runnables: dict[str, Runnable] = field(default_factory=dict)

    @property
    def profile(self) -> Profile:
        """Execution times on the controller."""
        return Profile(self.controller, self.notes)

    def core(self, stated: str | None, location: Location | None) -> str:
        """A core that is stated, or the first one."""
        if stated is None:
            return self.controller.first_core
        if stated not in self.controller.frequencies:
            self.notes.unknown("core", stated, self.controller.frequencies, location)
            return self.controller.first_core
        return stated
