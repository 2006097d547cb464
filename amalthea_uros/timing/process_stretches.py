"""The stretches of processes, with their demand on a core; many levels and busy windows ask for the same ones."""

from __future__ import annotations

from dataclasses import dataclass, field

from amalthea_uros.perf.activities import Activity
from amalthea_uros.perf.software import Process
from amalthea_uros.timing.demand import DemandModel
from amalthea_uros.timing.stretches import KeptOff, Stretches, StretchWalk
from amalthea_uros.units import Time


@dataclass(slots=True)
class ProcessStretches:
    """The stretches of processes, each found once."""

    demand_model: DemandModel
    _found: dict[tuple[str, str, KeptOff], Stretches] = field(default_factory=dict)

    def of(self, process: Process, core: str, kept_off: KeptOff) -> Stretches:
        """The stretches of the jobs of a process on a core, in its time base; raises as `StretchWalk.of`."""
        key = (process.name, core, kept_off)
        if key not in self._found:
            self._found[key] = self._find(process, core, kept_off)
        return self._found[key]

    def _find(self, process: Process, core: str, kept_off: KeptOff) -> Stretches:
        model = self.demand_model

        def demand_of(activity: Activity) -> Time:
            return model.of_activities(process, (activity,), core).worst

        return StretchWalk(model.system, kept_off, demand_of, model.possible_branches).of(process.activities)
