"""A stage of a chain with its read and write times."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadWriteBounds:
    """Bounds of the times at which the jobs of a stage read and write.

    Attributes
    ----------
    pessimistic : earliest reads and latest writes
    optimistic : latest reads and earliest writes
    steady_state_start : time from which both repeat
    is_exact : whether both are the actual times
    is_logical : whether they depend only on releases and periods
    """

    pessimistic: ReadWriteTimes
    optimistic: ReadWriteTimes
    steady_state_start: Time
    is_exact: bool = False
    is_logical: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedStage:
    """A stage, together with those that it triggers, with its read and write times.

    Attributes
    ----------
    task : as the bounds see it
    read_write : None if they are unknown
    reason : why they are unknown
    """

    task: ChainTask
    read_write: ReadWriteBounds | None = None
    reason: str = ""

    @property
    def is_exact(self) -> bool:
        """Whether the read and write times of each job are known exactly."""
        return self.read_write is not None and self.read_write.is_exact

    @property
    def is_logical(self) -> bool:
        """Whether read and write times depend only on releases and periods."""
        return self.read_write is not None and self.read_write.is_logical
