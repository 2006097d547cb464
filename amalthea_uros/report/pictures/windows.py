"""The part of time that a picture shows."""

from __future__ import annotations

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.ticks import nice_step
from amalthea_uros.units import MICROSECOND, Time, time_text

#: On each side a tenth of what is shown, and the ends at multiples of about a twentieth.
_MARGIN, _PARTS = 10, 20
#: What has no length is shown in the middle of a window of about this one.
_SHORTEST = MICROSECOND


def default_window(start: Time, end: Time) -> tuple[Time, Time]:
    """A window around a job, from its activation to its end, or around the way of a chain: with a margin and round ends.

    Raises
    ------
    InvalidArgumentError : the end is before the start.
    """
    if end < start:
        raise InvalidArgumentError(f"a window cannot start at {time_text(start)} and end before, at {time_text(end)}")
    margin = -(-max(end - start, _SHORTEST) // _MARGIN)
    step = nice_step(end - start + 2 * margin, _PARTS)
    left, right = (start - margin) // step * step, -(-(end + margin) // step) * step
    return (left if start < 0 else max(left, 0)), right


def check_window(start: Time, end: Time) -> None:
    """InvalidArgumentError if there is nothing between start and end."""
    if end <= start:
        raise InvalidArgumentError(
            f"the window of a picture must end after it starts, not at {time_text(end)} as it starts at {time_text(start)}"
        )
