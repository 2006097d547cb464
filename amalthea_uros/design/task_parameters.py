"""A task of a synthetic task set: its parameters, checked and exact."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from math import ceil, floor
from operator import index
from typing import Literal, TypeVar

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.activities import (
    Communication,
)
from amalthea_uros.perf.software import Preemption
from amalthea_uros.timing.basics.stated_times import TimeLike, stated_time
from amalthea_uros.units import Time, time_text

E = TypeVar("E", Preemption, Communication)


@dataclass(frozen=True, slots=True, kw_only=True)
class TaskParameters:
    """The parameters of a synthetic task; `task` makes it of texts.

    Attributes
    ----------
    period : time from one activation to the next; None for a sporadic task
    min_distance : least time from one activation to the next of a sporadic task
    bcet, wcet : execution times
    deadline : relative to the activation; None: the period or the minimum distance
    offset : time of the first activation; None: any, so that results hold for every combination of phases
    jitter : greatest delay of an activation
    priority : higher numbers are served first; None: not stated
    communication : when the task reads and writes the data of its chains; None: not stated, which means implicit
    critical_sections : maximum execution time that a job holds each resource; part of the execution time
    """

    name: str
    period: Time | None
    min_distance: Time | None
    bcet: Time
    wcet: Time
    deadline: Time | None = None
    offset: Time | None = None
    jitter: Time = 0
    priority: int | None = None
    core: str = "Core_0"
    preemption: Preemption = Preemption.PREEMPTIVE
    communication: Communication | None = None
    critical_sections: Mapping[str, Time] = field(default_factory=dict, hash=False)

    @property
    def distance(self) -> Time:
        """The period or the minimum distance."""
        return self.period or self.min_distance or 0


def task(
    name: str,
    *,
    wcet: TimeLike,
    period: TimeLike | None = None,
    min_distance: TimeLike | None = None,
    bcet: TimeLike = 0,
    deadline: TimeLike | None = None,
    offset: TimeLike | None = None,
    jitter: TimeLike = 0,
    priority: int | None = None,
    core: str = "Core_0",
    preemption: Literal["preemptive", "cooperative", "non-preemptive"] = "preemptive",
    communication: Literal["implicit", "explicit", "LET"] | None = None,
    critical_sections: Mapping[str, TimeLike] | None = None,
    unit: str | None = None,
) -> TaskParameters:
    """A task of a `taskset`; times are texts such as "5 ms", a `Duration`, a `timedelta`, or numbers of one `unit`.

    >>> control = task("Control", period="5 ms", wcet="1 ms", priority=3)
    >>> brake = task("Brake", min_distance=20, wcet=2, deadline=10, priority=4, unit="ms")

    Parameters
    ----------
    period, min_distance : one of them: a periodic task, or a sporadic one
    bcet : 0 if it is not stated, so that jobs may end at any time up to their worst case
    offset : of the first activation; if it is not stated, any phase is possible
    deadline : if it is not stated, the period or the minimum distance; it can be longer than these
    priority : higher numbers are served first
    critical_sections : resources of the core, and the execution time for which each job holds them, one after the other, at most; it
        is part of the `wcet`. Who holds a resource runs at its ceiling (immediate ceiling protocol)
    unit : of the numbers; without it, only 0 can be a number. Fractions of a picosecond are rounded to the safe side

    Raises
    ------
    InvalidArgumentError : a value is wrong.
    """

    def time(what: str, value: TimeLike, least: Time = 0) -> Time:
        return stated_time(f"{name}: {what}", value, unit, ROUNDING[what], least, _REMEDY)

    _check_text("the name of a task", name)
    _check_text(f"{name}: the core", core)
    if (period is None) == (min_distance is None):
        raise InvalidArgumentError(f"{name}: expected either a period, or the min_distance of a sporadic task")
    if communication == "LET" and offset is None:
        raise InvalidArgumentError(
            f"{name}: the times at which LET communication takes place need an offset; state it, e.g. '0 ms'"
        )
    if min_distance is not None and (offset is not None or jitter):
        raise InvalidArgumentError(f"{name}: a sporadic task has no offset and no jitter; use a period, or leave them out")
    made = TaskParameters(
        name=name,
        period=None if period is None else time("period", period, 1),
        min_distance=None if min_distance is None else time("min_distance", min_distance, 1),
        bcet=time("bcet", bcet),
        wcet=time("wcet", wcet),
        deadline=None if deadline is None else time("deadline", deadline, 1),
        offset=None if offset is None else time("offset", offset),
        jitter=time("jitter", jitter),
        priority=None if priority is None else _whole(f"{name}: the priority", priority),
        core=core,
        preemption=_member(name, "preemption", Preemption, preemption),
        communication=None if communication is None else _member(name, "communication", Communication, communication),
        critical_sections={each: time("critical_sections", held) for each, held in (critical_sections or {}).items()},
    )
    if made.bcet > made.wcet:
        raise InvalidArgumentError(f"{name}: the bcet {time_text(made.bcet)} exceeds the wcet {time_text(made.wcet)}")
    held = sum(made.critical_sections.values())
    if held > made.wcet:
        raise InvalidArgumentError(
            f"{name}: the critical sections take {time_text(held)}, more than the wcet {time_text(made.wcet)} that they are part of"
        )
    return made


_REMEDY = "state the unit of all numbers, e.g. unit='ms'"

#: To which side fractions of a picosecond are rounded; no side is the safe one for an offset.
ROUNDING: Mapping[str, Callable[[Fraction], int]] = {
    "period": floor,
    "min_distance": floor,
    "deadline": floor,
    "bcet": floor,
    "wcet": ceil,
    "jitter": ceil,
    "critical_sections": ceil,
    "offset": round,
}


def _whole(what: str, value: object) -> int:
    """An integer, also of numpy."""
    try:
        if isinstance(value, bool):
            raise TypeError
        return index(value)  # type: ignore[arg-type]
    except TypeError:
        raise InvalidArgumentError(f"{what}: expected a whole number, not {value!r}") from None


def _check_text(what: str, value: object) -> None:
    if not isinstance(value, str) or not value:
        raise InvalidArgumentError(f"{what} must be a text, not {value!r}")


def _member(name: str, what: str, kind: type[E], value: str) -> E:
    try:
        return kind(value)
    except ValueError:
        expected = ", ".join(kind)
        raise InvalidArgumentError(f"{name}: unknown {what} {value!r}; expected one of {expected}") from None
