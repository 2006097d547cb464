"""The processor as the thread of an executor on a host sees it: what can preempt it, and its supply.

Linux (sched(7)): SCHED_DEADLINE before SCHED_FIFO before SCHED_OTHER; among threads of SCHED_FIFO the higher priority is first, and
one of equal priority runs until it waits. A reservation of SCHED_DEADLINE provides its budget in each period, and nothing for twice
the rest of a period in the worst case (I. Shin and I. Lee, RTSS 2003). That holds if each reservation can have a core of its own,
or all of them fit on the only core; the global EDF of several cores promises less.
"""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.host import Host, HostExecutor, HostExecutorKind, HostPolicy
from amalthea_uros.timing.basics.time_base import Ticks
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import PeriodicEvents


@dataclass(frozen=True, slots=True)
class HostProcessor:
    """The processor of an executor.

    Attributes
    ----------
    higher : executors whose callbacks can preempt it
    reservations : threads of SCHED_DEADLINE that can preempt it, each as a task
    cores : on which its threads run; nothing can preempt them if there are several
    """

    higher: tuple[HostExecutor, ...] = ()
    reservations: tuple[AnalysedTask, ...] = ()
    supply: Supply = FULL
    cores: int = 1


def processor_of(executor: HostExecutor, host: Host) -> HostProcessor:
    """The processor of an executor.

    Raises
    ------
    UnknownError : something that is not specified can delay it, or no method covers it.
    """
    name, thread = executor.name, executor.thread
    if thread.policy is HostPolicy.OTHER:
        raise UnknownError(
            f"the thread of {name!r} has the policy 'other', so that any other thread of the computer can delay it; set 'thread', e.g. "
            "{policy: fifo, priority: 80, core: 0}"
        )
    neighbours = [other for other in host.executors if other.computer == executor.computer and other.name != name]
    if thread.policy is HostPolicy.DEADLINE:
        return _reserved(executor, neighbours, host)
    cores = set(thread.cores) or set(range(_cores(executor, host)))
    if executor.kind is not HostExecutorKind.MULTI_THREADED and len(cores) > 1:
        raise UnknownError(f"the thread of {name!r} can run on several cores; set 'core' of its 'thread'")
    higher = tuple(other for other in neighbours if _can_preempt(other, executor, cores))
    reservations = tuple(map(_reservation, filter(_is_reserved, neighbours)))
    if len(cores) > 1 and (higher or reservations):
        raise UnknownError(
            f"other threads can preempt those of {name!r}, which no published method covers; give it cores of its own"
        )
    return HostProcessor(higher, reservations, cores=len(cores))


def _cores(executor: HostExecutor, host: Host) -> int:
    return next(computer.cores for computer in host.computers if computer.name == executor.computer)


def _is_reserved(executor: HostExecutor) -> bool:
    return executor.thread.policy is HostPolicy.DEADLINE


def _can_preempt(other: HostExecutor, executor: HostExecutor, cores: set[int]) -> bool:
    thread = other.thread
    shares_core = not thread.cores or bool(cores.intersection(thread.cores))
    return thread.policy is HostPolicy.FIFO and thread.priority >= executor.thread.priority and shares_core


def _reserved(executor: HostExecutor, neighbours: list[HostExecutor], host: Host) -> HostProcessor:
    thread, cores = executor.thread, _cores(executor, host)
    reserved = [executor, *filter(_is_reserved, neighbours)]
    if executor.kind is HostExecutorKind.MULTI_THREADED:
        raise UnknownError(f"no published method covers the reservation of the multi-threaded executor {executor.name!r}")
    share = sum(Fraction(each.thread.budget, each.thread.period) for each in reserved)
    if len(reserved) > cores and (cores > 1 or share > 1):
        raise UnknownError(f"more reservations than cores on {executor.computer!r}: that of {executor.name!r} can be late")
    return HostProcessor(supply=Supply(budget=thread.budget, period=thread.period, wait=2 * (thread.period - thread.budget)))


def _reservation(executor: HostExecutor) -> AnalysedTask:
    """A reservation as a task: it can use a budget at the end of a period, and the next one at once."""
    thread = executor.thread
    return AnalysedTask(
        name=executor.name,
        events=PeriodicEvents(thread.period, thread.period - thread.budget),
        demand=MultiframeDemand.constant(Ticks(thread.budget)),
    )
