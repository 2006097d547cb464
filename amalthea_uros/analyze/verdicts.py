"""Verdicts: a limit compared with what is known about the maximum or minimum that it limits."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from amalthea_uros.units import Time, time_text


class Verdict(StrEnum):
    """Whether a deadline, requirement or constraint is met; unbounded: an overload makes it impossible."""

    MET = "met"
    MISSED = "missed"
    UNBOUNDED = "unbounded"
    UNKNOWN = "unknown"


class Failure(StrEnum):
    """What is wrong with a process."""

    MISSED = "missed"
    LOST = "lost"
    OVERLOAD = "overload"


@dataclass(frozen=True, slots=True)
class Ends:
    """Between which ends the maximum or minimum of a quantity lies, in all behaviours of the system.

    Attributes
    ----------
    lower, upper : equal if the value is exact; None if that end is unknown or infinite
    """

    lower: Time | None = None
    upper: Time | None = None

    @classmethod
    def exactly(cls, value: Time) -> Ends:
        """Those of a value that is known."""
        return cls(value, value)


def decide(ends: Ends, limit: Time, is_upper: bool) -> Verdict:
    """The verdict on a limit: met or missed only if both ends agree on it.

    Parameters
    ----------
    is_upper : whether a maximum must not exceed the limit; otherwise a minimum must not fall below it
    """
    safe, other = (ends.upper, ends.lower) if is_upper else (ends.lower, ends.upper)
    if safe is not None and _holds(safe, limit, is_upper):
        return Verdict.MET
    if other is not None and not _holds(other, limit, is_upper):
        return Verdict.MISSED
    return Verdict.UNKNOWN


def _holds(value: Time, limit: Time, is_upper: bool) -> bool:
    return value <= limit if is_upper else value >= limit


def undecided(ends: Ends, is_upper: bool) -> str:
    """Why a limit that lies between the ends is neither met nor missed."""
    what = "maximum" if is_upper else "minimum"
    match ends.lower, ends.upper:
        case int(lower), int(upper):
            return f"the {what} is between {time_text(lower)} and {time_text(upper)}"
        case int(lower), None:
            return f"the {what} is at least {time_text(lower)}, and no upper bound is known"
        case None, int(upper):
            return f"the {what} is at most {time_text(upper)}, and no lower bound is known"
    return f"the {what} is unknown"
