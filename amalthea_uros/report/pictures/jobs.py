"""What pictures show of processes: their jobs, and the states of these over time."""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros._internal.records import dataclass
from amalthea_uros.units import Time


class State(StrEnum):
    """A state of a job, as of BTF; in the order in which boxes cover each other, so that what holds a core is seen."""

    ACTIVE = "active"
    WAITING = "waiting"
    READY = "ready"
    PARKING = "parking"
    POLLING = "polling"
    RUNNING = "running"


#: The states in which a job holds its core.
ON_CORE = frozenset((State.RUNNING, State.POLLING))


@dataclass(frozen=True, slots=True)
class StateSpan:
    """A job is in a state from `start` to `end`; `core` is where it runs or polls, if that is known."""

    state: State
    start: Time
    end: Time
    core: str = ""


@dataclass(frozen=True, slots=True)
class RunnableSpan:
    """A runnable runs from `start` to `end`."""

    name: str
    start: Time
    end: Time


@dataclass(frozen=True, slots=True)
class Job:
    """One job of a process.

    Attributes
    ----------
    instance : its number
    spans : its states, in the order of time
    activation : None if it is not known, such as before the start of a trace
    end : None if it is not known, such as after the end of a trace
    deadline : a point in time, not a distance; None if it has none
    runnables : in the order in which they are drawn, those that call before those that are called
    """

    instance: int
    spans: tuple[StateSpan, ...]
    activation: Time | None = None
    end: Time | None = None
    deadline: Time | None = None
    runnables: tuple[RunnableSpan, ...] = ()

    def misses_deadline(self, now: Time) -> bool:
        """Whether it ends after its deadline, or has not ended `now` and is too late already."""
        return self.deadline is not None and (now if self.end is None else self.end) > self.deadline

    def is_in(self, start: Time, end: Time) -> bool:
        """Whether anything of it is in a window."""
        ends = [moment for span in (*self.spans[:1], *self.spans[-1:]) for moment in (span.start, span.end)]
        known = [moment for moment in (self.activation, self.end, *ends) if moment is not None]
        return bool(known) and min(known) <= end and max(known) >= start


@dataclass(frozen=True, slots=True)
class ProcessRow:
    """A process, its jobs, and the points in time at which an activation was lost."""

    name: str
    jobs: tuple[Job, ...]
    lost: tuple[Time, ...] = ()


@dataclass(frozen=True, slots=True)
class CoreRows:
    """The processes of a core."""

    name: str
    rows: tuple[ProcessRow, ...]
