"""The part of a trace that is measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import Time, time_text

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Window:
    """From a time on and before another one, in picoseconds from the first event.

    Raises
    ------
    InvalidArgumentError : it ends before it starts.
    """

    start: Time = 0
    end: Time | None = None

    def __post_init__(self) -> None:
        if self.end is not None and self.end <= self.start:
            raise InvalidArgumentError(
                f"the part to measure ends at {time_text(self.end)}, and starts at {time_text(self.start)}; it must end later"
            )

    @property
    def is_all(self) -> bool:
        """Whether it is the whole trace."""
        return self.start == 0 and self.end is None

    def holds(self, times: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which times are in it; before the first event, after a step back of the clock, none is unless all are."""
        import numpy as np

        if self.is_all:
            return np.ones(len(times), bool)
        return (times >= self.start) & (times < self.end if self.end is not None else True)
