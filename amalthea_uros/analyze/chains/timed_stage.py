"""A stage of a chain in time."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.chains.bounds.chain_task import Step
from amalthea_uros.analyze.chains.job_times import Track
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class Tracks:
    """When the jobs of a stage read and write.

    Attributes
    ----------
    widest : earliest reads and latest writes
    narrowest : latest reads and earliest writes
    settled : time behind which both repeat
    is_exact : whether both are what happens
    is_logical : whether only releases and periods decide
    """

    widest: Track
    narrowest: Track
    settled: Time
    is_exact: bool = False
    is_logical: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Timed:
    """A stage, with those that it triggers, in time.

    Attributes
    ----------
    tracks : None where releases are not known
    reason : why they are not
    """

    step: Step
    tracks: Tracks | None = None
    reason: str = ""

    @property
    def is_exact(self) -> bool:
        """Whether it is known when each job reads and writes."""
        return self.tracks is not None and self.tracks.is_exact

    @property
    def is_logical(self) -> bool:
        """Whether only releases and periods decide."""
        return self.tracks is not None and self.tracks.is_logical
