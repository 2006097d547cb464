"""What processes and runnables do, as trees of activities."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from enum import StrEnum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.perf.conditions import Condition
from amalthea_uros.perf.distributions import Distribution
from amalthea_uros.perf.named import Locate
from amalthea_uros.perf.stimuli import Counter


@dataclass(frozen=True, slots=True)
class Demand:
    """Execution demand in ticks.

    Attributes
    ----------
    ticks : on any core; None if it is given for some core types only
    by_core_type : on cores of a type, instead
    """

    ticks: Distribution[int] | None = None
    by_core_type: tuple[tuple[str, Distribution[int]], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class AbstractActivity:
    """What all activities have.

    Attributes
    ----------
    locate : finds the place in a file that it comes from; None: it does not come from a file
    """

    locate: Locate | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Execute(AbstractActivity):
    """Computation that takes ticks of the core's clock."""

    demand: Demand


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutionNeed(AbstractActivity):
    """Computation counted in something else, such as instructions, that a feature of the core type converts to ticks."""

    needs: tuple[tuple[str, Distribution[int]], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Call(AbstractActivity):
    """Execution of a runnable within the caller.

    Attributes
    ----------
    times : how often the runnable is called here, where that is known; a fraction is an average without a maximum
    """

    runnable: str
    counter: Counter | None = None
    times: Count | float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Count:
    """A number that was measured or estimated: least, mean, most."""

    least: int
    mean: float
    most: int


class AccessKind(StrEnum):
    """What an access does."""

    READ = "read"
    WRITE = "write"


class Communication(StrEnum):
    """When the data of a job are read and written: where the accesses stand, at its start and end, or at its period."""

    EXPLICIT = "explicit"
    IMPLICIT = "implicit"
    LET = "LET"


class Protection(StrEnum):
    """How a label is kept consistent."""

    NONE = "none"
    AUTOMATIC = "automatic"
    CUSTOM = "custom"
    BY_MODEL = "by model elements"
    INHERITED = "inherited"


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelAccess(AbstractActivity):
    """Read or write of a label.

    Attributes
    ----------
    communication : None: not stated
    times : how many accesses this stands for
    """

    label: str
    kind: AccessKind
    communication: Communication | None = None
    protection: Protection | None = None
    times: Count | float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SenderReceiverAccess(AbstractActivity):
    """Read or write of a label by sender-receiver communication.

    Attributes
    ----------
    notifies : runnables that are notified of a write
    """

    label: str
    kind: AccessKind
    buffered: bool = False
    notifies: tuple[str, ...] = ()


class ServerCallKind(StrEnum):
    """Whether a client waits for the server, goes on at once, or fetches the result of an earlier call."""

    SYNCHRONOUS = "synchronous"
    ASYNCHRONOUS = "asynchronous"
    GET_RESULT = "get result"


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerCall(AbstractActivity):
    """Call of a runnable of a server.

    Attributes
    ----------
    result : runnable that is executed when the result of an asynchronous call has arrived
    waits : whether a client waits for a result that has not arrived yet
    waiting : how it waits; None: not stated
    """

    runnable: str
    kind: ServerCallKind = ServerCallKind.SYNCHRONOUS
    result: str | None = None
    waits: bool = True
    waiting: Waiting | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Group(AbstractActivity):
    """Activities taken together.

    Attributes
    ----------
    ordered : whether they run in the order given
    interruptible : whether they can be preempted
    """

    activities: tuple[Activity, ...]
    name: str = ""
    ordered: bool = True
    interruptible: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """A branch that is taken with a probability: its weight divided by the sum of all weights."""

    weight: float
    activities: tuple[Activity, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ProbabilitySwitch(AbstractActivity):
    """One of several branches, by chance."""

    branches: tuple[Chance, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A branch that is taken if its condition holds and none before it did."""

    activities: tuple[Activity, ...]
    condition: Condition | None = None
    name: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Switch(AbstractActivity):
    """The first branch whose condition holds, or else the default."""

    cases: tuple[Case, ...]
    default: tuple[Activity, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Loop(AbstractActivity):
    """Repeated while the condition holds, which is tested first."""

    activities: tuple[Activity, ...]
    condition: Condition | None = None


class SemaphoreOperation(StrEnum):
    """What is done with a semaphore; exclusive waits until nobody else holds it."""

    REQUEST = "request"
    EXCLUSIVE = "exclusive"
    RELEASE = "release"


class Waiting(StrEnum):
    """Whether who waits keeps the core (active, polling) or gives it away (passive)."""

    ACTIVE = "active"
    PASSIVE = "passive"


@dataclass(frozen=True, slots=True, kw_only=True)
class SemaphoreAccess(AbstractActivity):
    """Begin or end of a critical section."""

    semaphore: str
    operation: SemaphoreOperation
    waiting: Waiting | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Trigger(AbstractActivity):
    """Firing of an inter-process stimulus."""

    stimulus: str
    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RaiseEvent(AbstractActivity):
    """Raising of a custom event."""

    event: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SetEvent(AbstractActivity):
    """Setting of OS events, for one process or (None) for every one."""

    events: tuple[str, ...]
    process: str | None = None
    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ClearEvent(AbstractActivity):
    """Clearing of OS events."""

    events: tuple[str, ...]
    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class WaitEvent(AbstractActivity):
    """Waiting for OS events, for all of them or for any."""

    events: tuple[str, ...]
    all_of_them: bool = True
    waiting: Waiting | None = None
    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Send(AbstractActivity):
    """Putting elements into a channel."""

    channel: str
    elements: int = 1


class ReceiveOperation(StrEnum):
    """From which end of a channel, and whether the elements are taken out."""

    FIFO_READ = "FIFO read"
    FIFO_TAKE = "FIFO take"
    LIFO_READ = "LIFO read"
    LIFO_TAKE = "LIFO take"


@dataclass(frozen=True, slots=True, kw_only=True)
class Receive(AbstractActivity):
    """Getting elements out of a channel."""

    channel: str
    elements: int = 1
    operation: ReceiveOperation | None = None
    must_be_new: bool = False
    index: int = 0
    at_least: int = 0


class ModeOperation(StrEnum):
    """What is done with a mode label."""

    READ = "read"
    SET = "set"
    INCREMENT = "increment"
    DECREMENT = "decrement"


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeAccess(AbstractActivity):
    """Access to a mode label; `value` is what is set, `step` by how much it changes."""

    label: str
    operation: ModeOperation
    value: str | None = None
    step: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class SchedulePoint(AbstractActivity):
    """Call of the scheduler, where cooperative tasks can be preempted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Terminate(AbstractActivity):
    """Immediate end of the job."""

    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Migrate(AbstractActivity):
    """Move of the task to another scheduler."""

    scheduler: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Incomplete(AbstractActivity):
    """Something that a model contains without stating what it is: it may take any time.

    Attributes
    ----------
    reason : what is not stated
    is_access : whether it is at least known to be an access to data, which takes the time of a memory access only
    label : what is accessed, if that is known and only the kind of the access is not
    """

    reason: str
    is_access: bool = False
    label: str | None = None


Activity: TypeAlias = (
    Execute
    | ExecutionNeed
    | Call
    | LabelAccess
    | Group
    | ProbabilitySwitch
    | Switch
    | Loop
    | SemaphoreAccess
    | Trigger
    | RaiseEvent
    | SetEvent
    | ClearEvent
    | WaitEvent
    | Send
    | Receive
    | SenderReceiverAccess
    | ServerCall
    | ModeAccess
    | SchedulePoint
    | Terminate
    | Migrate
    | Incomplete
)


#: The classes of activities that contain others; most activities are accesses.
WITH_PARTS = (Group, Loop, ProbabilitySwitch, Switch)


def walk(activities: tuple[Activity, ...]) -> Iterator[Activity]:
    """All activities with those inside groups, branches and loops, in order."""
    for activity in activities:
        yield activity
        if isinstance(activity, WITH_PARTS):
            for inner in inner_activities(activity):
                yield from walk(inner)


def called_runnables(activities: tuple[Activity, ...]) -> Iterator[str]:
    """The runnables that activities call, also inside groups, branches and loops."""
    return (activity.runnable for activity in walk(activities) if isinstance(activity, Call))


def inner_activities(activity: Activity) -> tuple[tuple[Activity, ...], ...]:
    """The lists of activities in a group, in branches and in a loop."""
    match activity:
        case Group() | Loop():
            return (activity.activities,)
        case ProbabilitySwitch():
            return tuple(branch.activities for branch in activity.branches)
        case Switch():
            return (*(case.activities for case in activity.cases), activity.default or ())
    return ()


def transformed(activities: tuple[Activity, ...], change: Callable[[Activity], Activity]) -> tuple[Activity, ...]:
    """The activities with all changed that contain no others, also those inside groups, branches and loops."""
    return tuple(_transformed(activity, change) for activity in activities)


def _transformed(activity: Activity, change: Callable[[Activity], Activity]) -> Activity:
    match activity:
        case Group(activities=inner) | Loop(activities=inner):
            return replace(activity, activities=transformed(inner, change))
        case ProbabilitySwitch(branches=branches):
            chances = tuple(replace(branch, activities=transformed(branch.activities, change)) for branch in branches)
            return replace(activity, branches=chances)
        case Switch(cases=cases, default=default):
            changed = tuple(replace(case, activities=transformed(case.activities, change)) for case in cases)
            return replace(activity, cases=changed, default=None if default is None else transformed(default, change))
    return change(activity)
