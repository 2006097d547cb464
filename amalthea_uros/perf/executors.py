"""Executors: threads that wait for messages and timers in a loop, and call what is ready, one callback after the other.

Executors have a model of their own, as no stimulus activates their iterations: when the next one begins depends on the one before, on
what has arrived, and on what the thread waits for. In `software`, its task executes one iteration per job.
"""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.units import Time


class LoopKind(StrEnum):
    """What a thread does between two waits of its endless loop; the values are those of files."""

    #: It sleeps after each iteration.
    SLEEPING = "spin_some"
    #: It sleeps until one period after the last invocation time.
    PERIODIC = "spin_period"
    #: The next wait follows at once.
    CONTINUOUS = "spin"


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreadLoop(Brief):
    """The loop of a thread.

    Attributes
    ----------
    timeout : of each wait
    sleep : maximum time that it sleeps after each iteration, if it is sleeping; 0 for a bare loop
    sleep_early : time by which a sleep can be shorter, as operating systems count in ticks
    pace : minimum time between the ends of two sleeps that follow each other, if that is more than the shortest sleep
    period : of a periodic loop; None for the others
    """

    kind: LoopKind
    timeout: Time
    sleep: Time = 0
    sleep_early: Time = 0
    pace: Time = 0
    period: Time | None = None


class HandleKind(StrEnum):
    """The role of a handle of an executor."""

    SUBSCRIPTION = "subscription"
    TIMER = "timer"
    SERVICE = "service"
    CLIENT = "client"
    GUARD_CONDITION = "guard condition"
    ACTION_SERVER = "action server"
    ACTION_CLIENT = "action client"
    PARAMETER_SERVICE = "parameter service"
    LIFECYCLE_SERVICE = "lifecycle service"
    #: A loop publishes itself, or asks the agent for something, in every iteration.
    LOOP_ITEM = "loop item"


@dataclass(frozen=True, slots=True, kw_only=True)
class Publication(Brief):
    """A message that a callback sends.

    Attributes
    ----------
    transmission : what it is on the wire; None if no wire is described
    reliable : whether it is sent again until it is acknowledged
    acknowledgement : the transmission that acknowledges or answers it; None if nothing does
    waits : whether the callback waits for the acknowledgement
    timeout : after which it no longer waits; None if it does not wait at all
    attempts : how often it is sent at most until it is answered, within the timeout
    """

    topic: str
    transmission: str | None = None
    reliable: bool = False
    acknowledgement: str | None = None
    waits: bool = False
    timeout: Time | None = None
    attempts: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Handle(Named):
    """A handle of an executor: what makes a callback ready, and the callback.

    Attributes
    ----------
    runnable : the callback
    take : the runnable that takes its message; None if that costs nothing
    interval : minimum time between two messages or requests, before `jitter`; the period of a timer; None if it is not known
    jitter : maximum delay of a message against its nominal time when it reaches the controller, besides that of the wire
    is_periodic : whether messages come regularly, every `interval`; timers always are
    phase : time of the first message or expiration; None if it is not known
    transmission : what brings its messages; None if no wire is described
    always : whether it is called in every iteration in which the trigger is true
    depth : most messages that are kept for it; None for timers and guard conditions
    overwrites : whether a message beyond `depth` overwrites the oldest one, or is dropped itself
    reliable : whether its messages are sent again until they are acknowledged
    sources : number of entities of the middleware that it adds to the wait set: 1, or several for actions
    """

    kind: HandleKind
    runnable: str
    take: str | None = None
    interval: Time | None = None
    jitter: Time = 0
    is_periodic: bool = True
    phase: Time | None = None
    transmission: str | None = None
    always: bool = False
    depth: int | None = None
    overwrites: bool = True
    reliable: bool = False
    sources: int = 1
    publications: tuple[Publication, ...] = ()


class TriggerKind(StrEnum):
    """When the callbacks of an iteration are called."""

    ANY = "any"
    ALL = "all"
    ONE = "one"
    ALWAYS = "always"
    CUSTOM = "custom"


@dataclass(frozen=True, slots=True, kw_only=True)
class TriggerCondition(Brief):
    """The trigger condition of an executor.

    Attributes
    ----------
    sets : for `one` and `custom`: it is true when all handles of one of these sets are ready; names of handles
    """

    kind: TriggerKind = TriggerKind.ANY
    sets: tuple[frozenset[str], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class WaitBehaviour(Brief):
    """How the middleware waits for an executor.

    Attributes
    ----------
    messages_per_wait : most messages that a wait takes from the wire; None for all that are there
    resolution : the timeout is cut to whole multiples of it, so that a wait can end earlier than a timer is due; 0 for none
    stored_data_ends_wait : whether data that are stored already end the wait at once
    guard_conditions_end_wait : whether a guard condition ends the wait
    polls_without_messages : whether the wait of an executor that only has timers and guard conditions returns at once
    slots : messages that can be stored for all handles together; None for no limit
    default_timeout : of executors for which nobody set one
    """

    messages_per_wait: int | None = 1
    resolution: Time = 10**9
    stored_data_ends_wait: bool = False
    guard_conditions_end_wait: bool = False
    polls_without_messages: bool = True
    slots: int | None = 8
    default_timeout: Time = 10**12


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreadPlace(Brief):
    """The place of an executor in a loop that several executors share: they spin one after the other, in the order of the system.

    Attributes
    ----------
    thread : a name that is the same for all of them
    sleep : maximum time that the thread sleeps between an iteration of this executor and that of the next one
    sleep_early : time by which that can be shorter
    """

    thread: str
    sleep: Time = 0
    sleep_early: Time = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Executor(Named):
    """An executor that spins in a loop.

    Attributes
    ----------
    task : that executes its iterations, one per job
    spin : the runnable that every iteration begins with
    poll : the runnable that stands for iterations without a callback, from the end of a wait until a timer is due; None for none
    busy_wait : the runnable in which its thread waits without sleeping, after each iteration; None for none
    place : in the loop of a thread that several executors share, whose `loop` then has all sleeps of the thread; None if it has its own
    handles : in the order in which they were added, which is that in which callbacks are called
    takes_first : whether all messages of an iteration are taken before the first callback (LET semantics)
    session : executors with the same one, of a middleware for several threads, exclude each other while they wait or send
    client : of the middleware, to which it belongs; "" in a system with one controller
    """

    task: str
    spin: str
    loop: ThreadLoop
    handles: tuple[Handle, ...] = ()
    trigger: TriggerCondition = field(default_factory=TriggerCondition)
    takes_first: bool = False
    waiting: WaitBehaviour = field(default_factory=WaitBehaviour)
    session: str | None = None
    client: str = ""
    poll: str | None = None
    busy_wait: str | None = None
    place: ThreadPlace | None = None
