"""The processor as the thread of an executor on a host sees it: what can preempt it, and its supply.

Linux (sched(7)): SCHED_DEADLINE before SCHED_FIFO before SCHED_OTHER; among threads of SCHED_FIFO the higher priority is first, and
one of equal priority runs until it waits. A reservation of SCHED_DEADLINE provides its budget in each period, and nothing for twice
the rest of a period in the worst case (I. Shin and I. Lee, RTSS 2003). That holds if each reservation can have a core of its own,
or if global EDF of their m cores meets all deadlines: the sum of their shares is at most m - (m - 1) u with the greatest share u
(J. Goossens, S. Funk and S. Baruah, Real-Time Systems 25, 2003; for servers S. Baruah, J. Goossens and G. Lipari, RTAS 2002). Threads
of a multi-threaded executor share a mutex, so that one without budget can hold up the others, which no published method covers.
SCHED_OTHER is fair among its threads, so that any other one can delay a thread, unless it is the only one of its core.
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
    if host.is_fairly_shared(executor):
        raise UnknownError(
            f"the thread of {name!r} has the policy 'other', so that any other thread of its cores can delay it; set 'thread', e.g. "
            "{policy: fifo, priority: 80, core: 0}"
        )
    cores = _cores(executor, host)
    rivals = [
        other
        for other in host.executors
        if other.computer == executor.computer and other.name != name and cores.intersection(_cores(other, host))
    ]
    reserved = [other for other in rivals if other.thread.policy is HostPolicy.DEADLINE]
    if thread.policy is HostPolicy.DEADLINE:
        return _reserved(executor, reserved, host)
    if executor.kind is not HostExecutorKind.MULTI_THREADED and len(cores) > 1:
        raise UnknownError(f"the thread of {name!r} can run on several cores; set 'core' of its 'thread'")
    higher = tuple(other for other in rivals if _can_preempt(other, executor))
    reservations = tuple(_reservation(other) for other in reserved for _ in range(other.threads))
    if len(cores) > 1 and (higher or reservations):
        raise UnknownError(
            f"other threads can preempt those of {name!r}, which no published method covers; give it cores of its own"
        )
    return HostProcessor(higher, reservations, cores=len(cores))


def _cores(executor: HostExecutor, host: Host) -> set[int]:
    """The cores on which the threads of an executor may run."""
    return set(executor.thread.cores) or set(range(host.computer_of(executor).cores))


def _can_preempt(other: HostExecutor, executor: HostExecutor) -> bool:
    return other.thread.policy is HostPolicy.FIFO and other.thread.priority >= executor.thread.priority


def _reserved(executor: HostExecutor, rivals: list[HostExecutor], host: Host) -> HostProcessor:
    """The reservation of an executor; rivals have one on cores of it."""
    thread, cores, reserved = executor.thread, _cores(executor, host), [executor, *rivals]
    if executor.kind is HostExecutorKind.MULTI_THREADED:
        raise UnknownError(
            f"a thread of {executor.name!r} that has used its budget up can hold up the others, which no published method covers"
        )
    shares = [Fraction(each.thread.budget, each.thread.period) for each in reserved for _ in range(each.threads)]
    guaranteed = len(cores) - (len(cores) - 1) * max(shares)
    if len(shares) > len(cores) and sum(shares) > guaranteed:
        raise UnknownError(
            f"the reservation of {executor.name!r} can be late: those on its cores need {float(sum(shares)):.3g} cores, and global EDF "
            f"guarantees no more than {float(guaranteed):.3g}"
        )
    if any(_cores(each, host) != cores for each in rivals):
        raise UnknownError(
            f"the reservation of {executor.name!r} shares some of its cores with others; set the same cores for all"
        )
    return HostProcessor(supply=Supply(budget=thread.budget, period=thread.period, wait=2 * (thread.period - thread.budget)))


def _reservation(executor: HostExecutor) -> AnalysedTask:
    """A reservation as a task: it can use a budget at the end of a period, and the next one at once."""
    thread = executor.thread
    return AnalysedTask(
        name=executor.name,
        events=PeriodicEvents(thread.period, thread.period - thread.budget),
        demand=MultiframeDemand.constant(Ticks(thread.budget)),
    )
