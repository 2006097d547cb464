"""Execution times as they are stated in a description, and what is written for others."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.design.description.text_edits import Path
from amalthea_uros.design.description.yaml_values import Value
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True)
class StatedTime:
    """The place of an execution time.

    Attributes
    ----------
    target : the object and the keys, such as "Executor_Task.execution_time.base"
    value : as it is; None if nothing is stated
    elsewhere : what is part of the execution time, but stated elsewhere, such as the time of publishing
    """

    target: str
    path: Path
    value: ExecutionTimeSection | None
    elsewhere: Time = 0

    def bounds(self, lower: Time, upper: Time) -> Value:
        """What is written for a range of whole execution times; ValueError if other parts alone take longer."""
        lower, upper = self._own(lower), self._own(upper)
        return time_text(lower) if lower == upper else {"min": time_text(lower), "max": time_text(upper)}

    def _own(self, time: Time) -> Time:
        if time <= self.elsewhere:
            raise ValueError(f"{time_text(time)} is not longer than the {time_text(self.elsewhere)} of its other parts")
        return time - self.elsewhere
