"""The stacks of processes: one for each task and interrupt service routine, or one per core that all of them share.

Processes share a stack if they run to completion, so that it is used like the stack of nested calls: what preempts lies on top of what
it preempts. The most that is used is the most of all chains of nested preemption. Processes that cannot preempt each other, because
they have the same priority or because a preemption threshold keeps them from it, are never in one chain (Wang and Saksena 1999; Davis,
Merriam and Tracey 2000, "How embedded applications using an RTOS can stay within on-chip memory limits").
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import inf

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.activities import Call, walk
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.system import System
from amalthea_uros.spec.description import Description
from amalthea_uros.timing.scheduling.allocation import allocated_cores, effective_priority
from amalthea_uros.uros.application.callbacks import sections_of
from amalthea_uros.uros.middleware.profile import MiddlewareThread, whole_bytes
from amalthea_uros.uros.network.receiving import name_for_other_frames
from amalthea_uros.uros.transports.line import receive_interrupt


def stacks_of(description: Description, system: System, threads: Iterable[MiddlewareThread]) -> StackUse:
    """The stacks of all tasks and interrupt service routines: one per core if the operating system says so, as OSEK does.

    Parameters
    ----------
    threads : of the middleware, with what the description says of them
    """
    own_threads = {thread.name: thread.stack for thread in threads} if description.application.nodes else {}
    sizes = dict(_stated(description)) | own_threads
    # Executors that spin in one loop use the stack of its thread, and so does what the loop sends itself.
    of_thread = {each.task: each.place.thread for each in system.executors if each.place is not None}
    sizes |= {task: sizes.get(thread) for task, thread in of_thread.items()}
    stack = description.os.stack
    if stack == "shared" or (stack is None and description.middleware.policy == "OSEK"):
        return shared_stacks(system, sizes)
    messages = {each.name for each in system.network.transmissions}
    tasks = [of_thread.get(task.name, task.name) for task in system.software.tasks if task.name not in messages]
    # Interrupt service routines run on the stack of the interrupts, or of the task that they interrupt: those that state one count.
    interrupt = receive_interrupt(description.middleware.transport)
    routines = {} if interrupt is None else {name_for_other_frames(interrupt): interrupt.name}
    own = [routines.get(isr.name, isr.name) for isr in system.software.isrs if sizes.get(isr.name) is not None]
    return separate_stacks(StackUser(name=name, size=sizes.get(name)) for name in dict.fromkeys([*tasks, *own, *own_threads]))


def _stated(description: Description) -> Iterator[tuple[str, int | None]]:
    middleware, interrupt = description.middleware, receive_interrupt(description.middleware.transport)
    # A callback in an executor states no stack: it uses that of the executor.
    named = [(each.name, each.stack) for each in middleware.stated_executors]
    named += [(each.name, each.stack) for each in (*description.tasks, *description.isrs)]
    named += [(each.name, each.stack) for node in description.application.nodes for _, each in sections_of(node)]
    if interrupt is not None:
        named += [(name, interrupt.stack) for name in (interrupt.name, name_for_other_frames(interrupt))]
    for name, stack in named:
        yield name, None if stack is None else whole_bytes(stack)


@dataclass(frozen=True, slots=True, kw_only=True)
class StackUser(Brief):
    """Something that runs on a stack.

    Attributes
    ----------
    size : in bytes; None if it is not specified
    """

    name: str
    size: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class StackUse(Brief):
    """What stacks take.

    Attributes
    ----------
    shared : whether the processes of a core share a stack
    size : in bytes, of all that is known
    users : with a size that is known: all of them; on shared stacks, those of the longest chains of preemption, lowest first
    unknown : those whose size is not specified; the size is then a lower bound
    """

    shared: bool
    size: int
    users: tuple[StackUser, ...]
    unknown: tuple[str, ...]


def separate_stacks(users: Iterable[StackUser]) -> StackUse:
    """The sum of all stacks."""
    every = tuple(users)
    known = tuple(user for user in every if user.size is not None)
    return StackUse(
        shared=False,
        size=sum(user.size or 0 for user in known),
        users=known,
        unknown=tuple(user.name for user in every if user.size is None),
    )


def shared_stacks(system: System, sizes: Mapping[str, int | None]) -> StackUse:
    """The most that is used of one stack per core.

    Parameters
    ----------
    sizes : most that each process uses itself
    """
    cores = allocated_cores(system)
    levels = _levels(system)
    chains = []
    for core in sorted({core for served in cores.values() for core in served}):
        chains.append(_longest([level for level in levels if core in cores.get(level.name, ())], sizes))
    users = tuple(
        StackUser(name=name, size=size) for chain in chains for name in chain if (size := sizes.get(name)) is not None
    )
    return StackUse(
        shared=True,
        size=sum(user.size or 0 for user in users),
        users=users,
        unknown=tuple(level.name for level in levels if sizes.get(level.name) is None),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _StackLevel:
    """A process with what decides who preempts it.

    Attributes
    ----------
    rank : interrupt service routines are above all tasks
    threshold : rank that something needs to exceed to preempt it
    is_cooperative, yields : whether it runs cooperatively, and then yields to other tasks between two of its functions
    """

    name: str
    rank: tuple[bool, float]
    threshold: tuple[bool, float]
    is_cooperative: bool = False
    yields: bool = False

    def is_preempted_by(self, other: _StackLevel) -> bool:
        """Whether the other one can run on top of it."""
        if self.is_cooperative and other.is_cooperative and not self.yields:
            return False
        return other.rank > self.threshold


def _levels(system: System) -> list[_StackLevel]:
    """The processes with a stack; messages on a wire have none."""
    messages = {each.name for each in system.network.transmissions}
    found = []
    for allocation in system.mapping.tasks:
        task = system.processes[allocation.task]
        if isinstance(task, Task) and task.name not in messages:
            priority = effective_priority(allocation, system) or 0
            found.append(
                _StackLevel(
                    name=task.name,
                    rank=(False, priority),
                    threshold=(False, inf if task.preemption is Preemption.NON_PREEMPTIVE else priority),
                    is_cooperative=task.preemption is Preemption.COOPERATIVE,
                    yields=sum(isinstance(each, Call) for each in walk(task.activities)) > 1,
                )
            )
    for routine in system.mapping.isrs:
        rank = (True, routine.priority or 0)
        found.append(_StackLevel(name=routine.isr, rank=rank, threshold=rank))
    return found


def _longest(levels: Sequence[_StackLevel], sizes: Mapping[str, int | None]) -> tuple[str, ...]:
    """The chain of nested preemption that uses most, lowest first: by dynamic programming from the highest rank down."""
    best: dict[str, tuple[int, tuple[str, ...]]] = {}
    done: list[_StackLevel] = []
    for level in sorted(levels, key=lambda level: level.rank, reverse=True):
        above = max(
            (best[other.name] for other in done if level.is_preempted_by(other)), key=lambda each: each[0], default=(0, ())
        )
        best[level.name] = (above[0] + (sizes.get(level.name) or 0), (level.name, *above[1]))
        done.append(level)
    return max(best.values(), key=lambda each: each[0], default=(0, ()))[1]
