"""A stage of a chain in time."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.analyze.chains.job_times import ReadWriteTimes
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadWriteBounds:
    """When the jobs of a stage read and write.

    Attributes
    ----------
    pessimistic : earliest reads and latest writes
    optimistic : latest reads and earliest writes
    steady_state_start : time behind which both repeat
    is_exact : whether both are what happens
    is_logical : whether only releases and periods decide
    """

    pessimistic: ReadWriteTimes
    optimistic: ReadWriteTimes
    steady_state_start: Time
    is_exact: bool = False
    is_logical: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedStage:
    """A stage, with those that it triggers, in time.

    Attributes
    ----------
    tracks : None where releases are not known
    reason : why they are not
    """

    step: ChainTask
    tracks: ReadWriteBounds | None = None
    reason: str = ""

    @property
    def is_exact(self) -> bool:
        """Whether it is known when each job reads and writes."""
        return self.tracks is not None and self.tracks.is_exact

    @property
    def is_logical(self) -> bool:
        """Whether only releases and periods decide."""
        return self.tracks is not None and self.tracks.is_logical
