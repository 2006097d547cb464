"""The windows after its release in which a job of a stage reaches its boundaries, by response times.

Where the schedule is not known, a job is at a position at the earliest when it has executed what comes before it, and at the latest
when what comes after it still fits into the response time, or when the busy window of the part up to the position ends.
"""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.chains.boundary_times import kind, position_of
from amalthea_uros.analyze.response_times.partial import time_until_executed
from amalthea_uros.analyze.results import Response
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.timing.dataflow.events import JobPhase
from amalthea_uros.timing.dataflow.stages import Boundary, Stage
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class BoundaryWindows:
    """When the jobs of a stage reach its boundaries, relative to their releases; times are in `unit` parts of a picosecond.

    Attributes
    ----------
    response : of its process, with a bounded worst case
    period : of its process, where a boundary is the end of the period
    """

    solution: Solution
    stage: Stage
    response: Response
    unit: int
    period: Time = 0

    def earliest(self, boundary: Boundary) -> Time:
        """A lower bound."""
        match kind(boundary):
            case JobPhase.ACTIVATION | JobPhase.START:
                return 0
            case JobPhase.END:
                return self.response.best * self.unit
            case None:
                return self.period
        before = self._before(boundary)
        return 0 if before is None else before.best * self.unit // self._time_base

    def latest(self, boundary: Boundary) -> Time:
        """An upper bound."""
        worst = (self.response.worst or 0) * self.unit
        match kind(boundary):
            case JobPhase.ACTIVATION:
                return 0
            case JobPhase.START:
                # After its start a job still executes its whole demand.
                return self._latest_after(0, self._demand.best)
            case JobPhase.END:
                return worst
            case None:
                return self.period
        before = self._before(boundary)
        if before is None:
            return worst
        # Overheads of the job that belong to no activity may all come first.
        process = self.stage.process
        everything = self.solution.context.demand_model.of_activities(process, process.activities, self._core)
        return self._latest_after(before.worst + self._demand.worst - everything.worst, everything.best - before.best)

    def _latest_after(self, executed: Time, left: Time) -> Time:
        """When a job has executed at most one demand and has at least another one left."""
        worst = (self.response.worst or 0) * self.unit
        part = time_until_executed(self.stage.process.name, executed, self.solution)
        if part is None:
            return max(0, worst - left * self.unit // self._time_base)
        found = -(-part * self.unit // self._time_base)
        return min(found, worst - left * self.unit // self._time_base) if left else found

    @property
    def _demand(self) -> MultiframeDemand:
        return self.solution.context.demands[self.stage.process.name]

    @property
    def _time_base(self) -> int:
        return self.solution.context.time_base(self.stage.process.name)

    def _before(self, boundary: Boundary) -> MultiframeDemand | None:
        """The demand of a job before a boundary inside it; None if that is uncertain."""
        position = position_of(boundary)
        if position is None or not position.is_certain:
            return None
        model = self.solution.context.demand_model
        return model.of_position(position, self._core, including=kind(boundary) is JobPhase.AFTER)

    @property
    def _core(self) -> str:
        return self.solution.context.scheduled[self.stage.process.name].core
