"""Operating systems: schedulers with their policies, interrupt controllers, overheads, semaphores."""

from __future__ import annotations

from enum import StrEnum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.activities import Demand, Execute, LabelAccess, Protection
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.units import Duration, Time


class Policy(StrEnum):
    """The scheduling policies that have a standard name; a scheduler may name any other one."""

    FIXED_PRIORITY_PREEMPTIVE = "FixedPriorityPreemptive"
    OSEK = "OSEK"
    FIXED_PRIORITY_WITH_BUDGETS = "FixedPriorityPreemptiveWithBudgetEnforcement"
    DEADLINE_MONOTONIC = "DeadlineMonotonic"
    RATE_MONOTONIC = "RateMonotonic"
    EARLIEST_DEADLINE_FIRST = "EarliestDeadlineFirst"
    LEAST_LOCAL_REMAINING_EXECUTION_TIME_FIRST = "LeastLocalRemainingExecutionTimeFirst"
    PRIORITY_BASED_ROUND_ROBIN = "PriorityBasedRoundRobin"
    PFAIR = "PfairPD2"
    PARTLY_PFAIR = "PartlyPFairPD2"
    EARLY_RELEASE_FAIR = "EarlyReleaseFairPD2"
    PARTLY_EARLY_RELEASE_FAIR = "PartlyEarlyReleaseFairPD2"
    DEFERRABLE_SERVER = "DeferrableServer"
    POLLING_SERVER = "PollingPeriodicServer"
    SPORADIC_SERVER = "SporadicServer"
    CONSTANT_BANDWIDTH_SERVER = "ConstantBandwidthServer"
    CONSTANT_BANDWIDTH_SERVER_WITH_CASH = "ConstantBandwidthServerWithCASH"
    GROUPING = "Grouping"


#: Policies that grant a budget in each period.
SERVERS = (
    Policy.DEFERRABLE_SERVER,
    Policy.POLLING_SERVER,
    Policy.SPORADIC_SERVER,
    Policy.CONSTANT_BANDWIDTH_SERVER,
    Policy.CONSTANT_BANDWIDTH_SERVER_WITH_CASH,
)


#: A time is a `Duration` here, because the value could also be a number.
ParameterValue: TypeAlias = bool | int | float | str | Duration


@dataclass(frozen=True, slots=True)
class Parameter:
    """A scheduling parameter beyond priority and deadline, such as a budget, a period or a task group.

    Attributes
    ----------
    values : one, or several where a policy takes a list
    """

    name: str
    values: tuple[ParameterValue, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Parent:
    """The scheduler that grants this one its time, and how it treats it."""

    scheduler: str
    priority: int | None = None
    deadline: Time | None = None
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Scheduler(Named):
    """A scheduler of tasks.

    Attributes
    ----------
    policy : a `Policy` or the name of another one; None: not known
    cores : those it decides for; several make it a global scheduler
    executing_core : the core that executes the scheduler itself
    overhead : what one scheduling decision costs
    """

    policy: str | None = None
    cores: tuple[str, ...] = ()
    executing_core: str | None = None
    parameters: tuple[Parameter, ...] = ()
    parent: Parent | None = None
    overhead: tuple[Execute | LabelAccess, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class InterruptController(Named):
    """What dispatches interrupt service routines; they outrank all tasks."""

    policy: str | None = None
    cores: tuple[str, ...] = ()
    executing_core: str | None = None
    parameters: tuple[Parameter, ...] = ()
    overhead: tuple[Execute | LabelAccess, ...] = ()


class Service(StrEnum):
    """A service of the operating system that costs time."""

    ACTIVATE_TASK = "activate task"
    TERMINATE_TASK = "terminate task"
    SCHEDULE = "schedule"
    REQUEST_RESOURCE = "request resource"
    RELEASE_RESOURCE = "release resource"
    REQUEST_SPINLOCK = "request spinlock"
    RELEASE_SPINLOCK = "release spinlock"
    SET_EVENT = "set event"
    WAIT_EVENT = "wait event"
    CLEAR_EVENT = "clear event"
    SEND_MESSAGE = "send message"
    ENFORCED_MIGRATION = "enforced migration"
    SUSPEND_INTERRUPTS = "suspend interrupts"
    RESUME_INTERRUPTS = "resume interrupts"
    SENDER_RECEIVER_READ = "sender receiver read"
    SENDER_RECEIVER_WRITE = "sender receiver write"
    SERVER_CALL = "server call"
    IOC_READ = "IOC read"
    IOC_WRITE = "IOC write"


@dataclass(frozen=True, slots=True, kw_only=True)
class IsrOverhead:
    """What the operating system adds before and after an interrupt service routine."""

    before: Demand | None = None
    after: Demand | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Overhead(Named):
    """What an operating system costs.

    Attributes
    ----------
    services : demand of a call, charged to the caller
    """

    services: tuple[tuple[Service, Demand], ...] = ()
    category_1: IsrOverhead | None = None
    category_2: IsrOverhead | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class OperatingSystem(Named):
    """An operating system on some cores.

    Attributes
    ----------
    protection : how it keeps labels consistent that state nothing themselves
    """

    schedulers: tuple[Scheduler, ...] = ()
    interrupt_controllers: tuple[InterruptController, ...] = ()
    overhead: str | None = None
    protection: Protection | None = None


class SemaphoreKind(StrEnum):
    """How a semaphore behaves."""

    COUNTING = "counting semaphore"
    RESOURCE = "resource"
    SPINLOCK = "spinlock"
    MUTEX = "mutex"


@dataclass(frozen=True, slots=True, kw_only=True)
class Semaphore(Named):
    """What protects critical sections.

    Attributes
    ----------
    users : most users at a time
    initial_users : users that hold it already at the start
    ceiling : whether the holder runs at the highest priority of all users
    ownership : whether only the holder may release it
    """

    kind: SemaphoreKind | None = None
    users: int = 1
    initial_users: int = 0
    ceiling: bool = False
    ownership: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Os(Brief):
    """Everything of operating systems in a system."""

    systems: tuple[OperatingSystem, ...] = ()
    overheads: tuple[Overhead, ...] = ()
    semaphores: tuple[Semaphore, ...] = ()
