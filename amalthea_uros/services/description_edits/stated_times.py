"""Execution times as they are stated in a description, and what is written for others."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from amalthea_uros.services.description_edits.text_edits import Path
from amalthea_uros.services.description_edits.yaml_values import Value
from amalthea_uros.spec.execution_time import ExecutionTime
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True)
class StatedTime:
    """The place of an execution time.

    Attributes
    ----------
    value : as it is; None if nothing is stated
    publishing : what is part of the execution time, but stated elsewhere: the time of publishing
    """

    path: Path
    value: ExecutionTime | None
    publishing: Time = 0

    def bounds(self, lower: Time, upper: Time) -> Value:
        """What is written for a range of whole execution times; ValueError if publishing alone takes longer."""
        lower, upper = self._own(lower), self._own(upper)
        return time_text(lower) if lower == upper else {"min": time_text(lower), "max": time_text(upper)}

    def with_mean(self, lower: Time, mean: Time, upper: Time) -> Value:
        """What is written for a range of whole execution times with their mean; raises as `bounds`."""
        if lower == upper:
            return self.bounds(lower, upper)
        lower, mean, upper = self._own(lower), self._own(mean), self._own(upper)
        return {"min": time_text(lower), "avg": time_text(mean), "max": time_text(upper)}

    def histogram(self, buckets: Iterable[tuple[Time, Time, int]]) -> Value:
        """What is written for the numbers of whole execution times in ranges; raises as `bounds`."""
        return {
            "histogram": [
                {"min": time_text(self._own(lower)), "max": time_text(self._own(upper)), "count": count}
                for lower, upper, count in buckets
            ]
        }

    def _own(self, time: Time) -> Time:
        if time <= self.publishing:
            what = f"publishing alone, which takes {time_text(self.publishing)}" if self.publishing else "any execution time"
            raise ValueError(f"{time_text(time)} is not longer than {what}")
        return time - self.publishing
