"""The results for executors, and the hops of messages outside them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import StrEnum
from fractions import Fraction
from typing import TypeVar

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Shown
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Time, time_text

V = TypeVar("V")


@dataclass(frozen=True, slots=True, kw_only=True)
class TimePart:
    """A part of a response time or of a hop; None for a maximum that is not known.

    Attributes
    ----------
    why : what it consists of
    """

    name: str
    least: Time = 0
    most: Time | None
    why: str = ""


class HopKind(StrEnum):
    """What takes the time of a hop."""

    AGENT = "agent"
    WIRE = "wire"
    LINK = "link"
    DRIVER = "driver"
    INTERRUPT = "interrupt"
    MIDDLEWARE = "middleware task"
    EXECUTOR = "executor"
    HOST = "host"
    TOPIC = "topic"
    POLLING = "polling"
    SAMPLING = "sampling"
    TASKS = "tasks"


@dataclass(frozen=True, slots=True, kw_only=True)
class Hop(Shown):
    """A part of a chain that crosses wires, the agent or executors in loops.

    Attributes
    ----------
    name : of the object that takes the time
    best, worst : bounds of that time; `worst` is None if it is unknown, for the `reason`
    source : what the bounds are based on: a method, or who stated them
    parts : what the worst case consists of; empty if it is one thing
    share : its part of the upper bound of the chain; None if that is unknown
    remedy : what to state or change, if it is unknown
    """

    kind: HopKind
    name: str
    best: Time
    worst: Time | None = None
    source: str = ""
    parts: tuple[TimePart, ...] = ()
    share: Fraction | None = None
    reason: str = ""
    remedy: str = ""


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
        due, or a guard condition is triggered; `worst` is None if there is no finite bound, for the `reason`
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
    terms: tuple[TimePart, ...] = ()

    def __repr__(self) -> str:
        worst = "unknown" if self.response.worst is None else time_text(self.response.worst)
        return f"<HandleResult {self.name}: response time {worst}>"


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutorResult(Shown):
    """An executor that spins in a loop.

    Attributes
    ----------
    round : bounds of the time from the end of a wait to the end of the last callback of the iteration
    loop : bounds of the time from the end of a wait to that of the next one
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


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutorOccurrences:
    """When executors send, and how late their iterations are.

    Attributes
    ----------
    sent : by the names of transmissions; None if that has no bound
    lateness : of the end of an iteration after what began it, by the names of tasks; None if that has no bound
    again : what is sent again besides, by the names of transmissions; or why that has no bound
    overrunning : the tasks of loops of which a wait and an iteration can take longer than the period, or for an unknown time
    """

    sent: Mapping[str, EventModel | None] = field(default_factory=dict)
    lateness: Mapping[str, Time | None] = field(default_factory=dict)
    again: Mapping[str, EventModel | str] = field(default_factory=dict)
    overrunning: frozenset[str] = frozenset()


def merged_occurrences(parts: Iterable[ExecutorOccurrences]) -> ExecutorOccurrences:
    """The occurrences of the executors of all controllers."""
    every = list(parts)
    return ExecutorOccurrences(
        sent=merged(each.sent for each in every),
        lateness=merged(each.lateness for each in every),
        again=merged(each.again for each in every),
        overrunning=frozenset(name for each in every for name in each.overrunning),
    )


def merged(mappings: Iterable[Mapping[str, V]]) -> dict[str, V]:
    """Several mappings as one, whose names differ."""
    return {name: value for each in mappings for name, value in each.items()}
