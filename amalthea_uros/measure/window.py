"""The part of a trace that is measured, and the smallest step of its time stamps."""

from __future__ import annotations

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True)
class MeasurementWindow:
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

    def contains(self, time: Time) -> bool:
        """Whether a time is in it, as `holds` says it of many."""
        return self.is_all or (self.start <= time and (self.end is None or time < self.end))

    def refuse_part(self, name: str) -> None:
        """Refuse to measure a part of a file that does not say when its values were complete.

        Raises
        ------
        InvalidArgumentError : it is not all.
        """
        if not self.is_all:
            raise InvalidArgumentError(
                f"{name!r} does not say when its values were measured, so no part of it can be; omit --from, --to and --skip"
            )

    def holds(self, times: Numbers) -> Flags:
        """Which times are in it; before the first event, after a step back of the clock, none is unless all are."""
        import numpy as np

        if self.is_all:
            return np.ones(len(times), bool)
        return (times >= self.start) & (times < self.end if self.end is not None else True)


# The smallest step of the time stamps of a trace.

#: From fewer different distances, no step can be concluded.
_ENOUGH = 20


def resolution_of(times: Numbers, stated: Time | None = None) -> Time | None:
    """The step of which all times are multiples, at least the stated one; None if it is not known.

    Parameters
    ----------
    stated : the step in which the format writes times; the clock may have a larger one
    """
    import numpy as np

    steps = np.unique(np.abs(np.diff(times)))
    if np.count_nonzero(steps) < _ENOUGH:
        return stated
    return max(int(np.gcd.reduce(steps)), stated or 0)
