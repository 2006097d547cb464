"""What sources say about an application of micro-ROS, each with its place."""

from __future__ import annotations

from collections.abc import Collection
from enum import StrEnum
from fractions import Fraction
from functools import cached_property

from amalthea_uros._internal.message_types import MessageType
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Location
from amalthea_uros.source.program import CodeFunction
from amalthea_uros.units import Time


class CodeEntityKind(StrEnum):
    """What is created."""

    NODE = "node"
    PUBLISHER = "publisher"
    SUBSCRIPTION = "subscription"
    TIMER = "timer"
    SERVICE = "service"
    CLIENT = "client"
    GUARD_CONDITION = "guard condition"
    ACTION_SERVER = "action server"
    ACTION_CLIENT = "action client"
    PARAMETER_SERVER = "parameter server"
    LIFECYCLE = "lifecycle node"


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeEntity:
    """Something that a function of rclc creates.

    Attributes
    ----------
    key : the variable that holds it
    variable : what it is called in the code
    node : the key of its node; "" for a node, and where the code does not say it
    name : of a node, topic, service or action; None if it is not constant
    type : of its messages; None if it cannot be read
    reliability : None if it cannot be read
    period : of a timer; None if it is not constant
    callback : key of the function that a timer calls
    options : of a parameter server: names with their value
    is_created : whether a function that is understood creates it; else it is only known that it is added to an executor
    """

    kind: CodeEntityKind
    key: str
    variable: str
    place: Location
    node: str = ""
    name: str | None = None
    type: MessageType | None = None
    reliability: str | None = None
    period: Time | None = None
    callback: CodeCallback | None = None
    options: tuple[tuple[str, bool], ...] = ()
    is_created: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeCallback:
    """A function that an executor calls.

    Attributes
    ----------
    name : as it is called in the code
    function : None if the sources do not define it
    """

    name: str
    function: CodeFunction | None


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeHandle:
    """Something that was added to an executor.

    Attributes
    ----------
    entity : its key
    callbacks : those that were given when it was added
    count : number of handles that it takes
    always : whether its callback is called without a message, too
    message : of a subscription, the variable that its messages are written to, as the code calls it
    """

    kind: CodeEntityKind
    entity: str
    callbacks: tuple[CodeCallback, ...]
    place: Location
    count: int = 1
    always: bool = False
    message: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Thread:
    """A task or thread of the operating system.

    Attributes
    ----------
    stack : in bytes; None if it is not constant
    priority, core : None if they are not stated, or not constant
    """

    name: str
    entry: CodeFunction | None
    place: Location
    stack: int | None = None
    priority: int | None = None
    core: int | None = None


class SpinKind(StrEnum):
    """How an executor spins, as `app.yaml` calls it."""

    SOME = "spin_some"
    PERIOD = "spin_period"
    ENDLESS = "spin"


class CodeLoopKind(StrEnum):
    """The kind of an item of a loop, as `app.yaml` calls it."""

    SPIN = "spin_some"
    SLEEP = "sleep"
    BUSY_WAIT = "busy_wait"
    PUBLISH = "publish"
    PING = "ping"
    SYNC = "sync"


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeLoopItem:
    """A part of the loop of a thread.

    Attributes
    ----------
    time : timeout, or how long it waits; None if it is not constant, or does not always happen
    of : key of the executor that spins, or of the publisher
    note : what to know about it
    attempts : how often it asks at most in its time
    every : the least time between two times that it sends, 0 for none
    """

    kind: CodeLoopKind
    time: Time | None
    place: Location
    of: str = ""
    note: str = ""
    attempts: int = 1
    every: Time = 0


class CodeLoop(tuple[CodeLoopItem, ...]):
    """The items of a loop, in order, which thousands of executors may share."""

    @cached_property
    def sleep(self) -> Time | None:
        """What the thread sleeps, or waits busily; None if that is not constant."""
        times = [item.time for item in self if item.kind in (CodeLoopKind.SLEEP, CodeLoopKind.BUSY_WAIT)]
        return None if None in times else Time(sum(filter(None, times)))

    @cached_property
    def executors(self) -> tuple[str, ...]:
        """Keys of the executors that spin, in order, each once."""
        return tuple(dict.fromkeys(item.of for item in self if item.kind is CodeLoopKind.SPIN))

    @cached_property
    def again(self) -> CodeLoopItem | None:
        """The first item in which an executor spins that did already in the same iteration, or that is in a loop of its own."""
        seen: set[str] = set()
        for item in self:
            if item.kind is CodeLoopKind.SPIN:
                if item.of in seen or item.note:
                    return item
                seen.add(item.of)
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Spin:
    """A call that lets an executor spin.

    Attributes
    ----------
    time : timeout or period; None if it is not constant
    items : everything in the same loop, if it is `spin_some` in one
    is_in_loop : whether it is repeated
    """

    kind: SpinKind
    time: Time | None
    place: Location
    items: CodeLoop
    is_in_loop: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeSender:
    """A loop that sends outside of callbacks, and in which no executor spins.

    Attributes
    ----------
    name : of its thread, else of the function that it is in
    """

    name: str
    thread: Thread | None
    items: CodeLoop
    place: Location


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeTrigger:
    """The trigger of an executor.

    Attributes
    ----------
    function : name without the prefix of rclc: any, all, one, always; else a function of the application
    object : key of what `one` waits for
    """

    function: str
    object: str
    is_custom: bool
    place: Location


@dataclass(slots=True, kw_only=True)
class CodeExecutor:
    """An executor.

    Attributes
    ----------
    max_handles : what it was initialised with; None if that is not constant
    timeout : set explicitly
    """

    key: str
    variable: str
    place: Location
    max_handles: int | None
    handle_by_entity: dict[tuple[CodeEntityKind, str], CodeHandle] = field(default_factory=dict)
    timeout: Time | None = None
    timeout_place: Location | None = None
    trigger: CodeTrigger | None = None
    semantics: str = "ROS"
    spins: list[Spin] = field(default_factory=list)
    thread: Thread | None = None

    @property
    def handles(self) -> Collection[CodeHandle]:
        """What was added to it, in order."""
        return self.handle_by_entity.values()


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeTransport:
    """The transport that the code sets.

    Attributes
    ----------
    key : as `app.yaml` calls it; None if the code does not say it
    values : its keys with values; None: to be filled in
    """

    key: str | None
    values: tuple[tuple[str, str | None], ...]
    note: str
    place: Location | None


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeOption:
    """A build option of the middleware; without a place it follows from the board that was named."""

    name: str
    value: str
    place: Location | None


@dataclass(frozen=True, slots=True)
class Stated:
    """A value of a file of a build system, with its place."""

    value: str
    place: Location


@dataclass(slots=True, kw_only=True)
class CodeFacts:
    """Everything.

    Attributes
    ----------
    threads : by the scopes of the functions that they begin with
    lock : where a thread takes the lock with which the application keeps its threads from using the session together
    publishes : keys of publishers and clients by the functions that use them, with the places
    types : those that the application defines, with the types of their fields
    rtos : the operating system, "" if unknown
    port : how micro-ROS was brought to the controller, "" if unknown
    ros, board, clock : distribution of ROS 2, name of the board, and clock in Hz, of files of the build system
    tick_rate : its ticks per second
    ticks_are_stated : whether that is more than a default of the port, which the build may change
    """

    entities: dict[str, CodeEntity] = field(default_factory=dict)
    executors: dict[str, CodeExecutor] = field(default_factory=dict)
    senders: list[CodeSender] = field(default_factory=list)
    threads: dict[str, Thread] = field(default_factory=dict)
    lock: Location | None = None
    publishes: dict[str, dict[str, Location]] = field(default_factory=dict)
    transport: CodeTransport | None = None
    types: dict[str, str] = field(default_factory=dict)
    options: dict[str, CodeOption] = field(default_factory=dict)
    rtos: str = ""
    port: str = ""
    ros: Stated | None = None
    board: Stated | None = None
    clock: Stated | None = None
    tick_rate: Fraction | None = None
    ticks_are_stated: bool = False
    findings: list[Finding] = field(default_factory=list)

    def described_places(self) -> set[Location]:
        """Where what the loops of the description have is."""
        spins = (spin.items for executor in self.executors.values() for spin in executor.spins)
        loops = {id(items): items for items in (*spins, *(sender.items for sender in self.senders))}
        return {item.place for items in loops.values() for item in items}

    def of_kind(self, kind: CodeEntityKind) -> list[CodeEntity]:
        """What was created of a kind, in order."""
        return [entity for entity in self.entities.values() if entity.kind is kind]
