"""The results for an executor that spins in a loop."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results import Response
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.network import Span
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A part of a response time.

    Attributes
    ----------
    why : what it consists of
    """

    name: str
    least: Time
    most: Time
    why: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Loss:
    """Messages, triggers or expirations of a timer that no call serves.

    Attributes
    ----------
    what : is lost, e.g. "periods"
    is_certain : whether they are lost in every run; otherwise it cannot be excluded
    most : how many are lost in one go; None if that is not known
    sequence : what has to happen for it, in words
    is_of_pool : whether messages are dropped because all slots are in use; otherwise by what is kept for a handle
    is_replaced : whether that is meant: a newer message or trigger takes the place of what is lost
    """

    what: str
    is_certain: bool
    most: int | None
    sequence: str
    is_of_pool: bool = False
    is_replaced: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class HandleResult(Shown):
    """A handle of an executor.

    Attributes
    ----------
    runnable : the callback
    interval : minimum time between two messages or triggers, or the period of a timer; None if it is not known
    response : from the release to the end of the callback; the release is when a message has arrived at the controller, a timer is
    due, or
        a guard condition is triggered; `worst` is None if there is no finite bound, for the `reason`
    lateness : from when a timer is due to the start of its call; None for others
    lost : None if nothing can be lost
    terms : the parts of the worst response time; they add up to it
    """

    name: str
    kind: HandleKind
    runnable: str
    interval: Time | None
    response: Response
    lateness: Span | None = None
    lost: Loss | None = None
    terms: tuple[Term, ...] = ()

    def __repr__(self) -> str:
        worst = "unknown" if self.response.worst is None else time_text(self.response.worst)
        return f"<HandleResult {self.name}: response time {worst}>"


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutorResult(Shown):
    """An executor that spins in a loop.

    Attributes
    ----------
    round : least and greatest time from the end of a wait to the end of the last callback of the round
    loop : least and greatest time from the end of a wait to that of the next one
    handles : in the order in which they are called
    reason : why nothing is known of it
    slots_needed : slots with which no message of the executors that share them finds none free; None if no number is known to be enough
    """

    name: str
    task: str
    round: Span
    loop: Span
    handles: Results[HandleResult]
    reason: str = ""
    slots_needed: int | None = None

    def __repr__(self) -> str:
        return f"<ExecutorResult {self.name}: {len(self.handles)} handles>"
