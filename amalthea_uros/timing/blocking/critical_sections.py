"""The semaphores that processes use: in which order they request them, and where they hold them exclusively."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros._internal.graphs import circles
from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.activities import Group, SemaphoreAccess, SemaphoreOperation, Waiting
from amalthea_uros.perf.os import SemaphoreKind
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.jobs.executed import executed
from amalthea_uros.timing.jobs.positions import ActivityPosition


@dataclass(frozen=True, slots=True)
class LockUsage:
    """What keeps others off during the jobs of a process, at any depth.

    Attributes
    ----------
    semaphores : that it uses
    awaited_actively : those for which it waits without giving the core away
    has_non_interruptible_group : whether it can execute one
    """

    semaphores: frozenset[str] = frozenset()
    awaited_actively: frozenset[str] = frozenset()
    has_non_interruptible_group: bool = False


def protection_of(process: Process, system: System) -> LockUsage:
    """What a process uses to keep others off."""
    if system.activity_classes.isdisjoint((SemaphoreAccess, Group)):
        return LockUsage()
    spinlocks = spinlocks_of(system)
    semaphores, actively, has_group = set[str](), set[str](), False
    for activity in executed(process.activities, system):
        match activity:
            case SemaphoreAccess(semaphore=name):
                semaphores.add(name)
                if waits_actively(activity, spinlocks):
                    actively.add(name)
            case Group(interruptible=False):
                has_group = True
    return LockUsage(frozenset(semaphores), frozenset(actively), has_group)


def spinlocks_of(system: System) -> frozenset[str]:
    """The semaphores for which processes wait actively unless they state something else."""
    return frozenset(semaphore.name for semaphore in system.os.semaphores if semaphore.kind is SemaphoreKind.SPINLOCK)


def waits_actively(access: SemaphoreAccess, spinlocks: frozenset[str]) -> bool:
    """Whether an access waits for its semaphore without giving the core away."""
    is_active = access.waiting is Waiting.ACTIVE or (access.waiting is None and access.semaphore in spinlocks)
    return is_active and access.operation is not SemaphoreOperation.RELEASE


def exclusively_held(positions: Sequence[ActivityPosition], system: System) -> Iterator[frozenset[str]]:
    """The semaphores that a process holds exclusively at each position.

    Activities are read in order, regardless of branches: a semaphore is held from its request to its release.
    """
    users = {semaphore.name: semaphore.users for semaphore in system.os.semaphores}
    held: frozenset[str] = frozenset()
    for position in positions:
        yield held
        access = position.activity
        if isinstance(access, SemaphoreAccess):
            if access.operation is SemaphoreOperation.RELEASE:
                held -= {access.semaphore}
            # A semaphore for several users excludes nobody unless it is requested exclusively.
            elif access.operation is SemaphoreOperation.EXCLUSIVE or users.get(access.semaphore, 1) <= 1:
                held |= {access.semaphore}


@dataclass(frozen=True, slots=True)
class Locks:
    """How processes wait at semaphores.

    Attributes
    ----------
    protection : of each process
    requests : for each semaphore, those that somebody requests while holding it
    """

    system: System
    protection: Mapping[str, LockUsage]
    requests: Mapping[str, set[str]]

    @property
    def open_semaphores(self) -> frozenset[str]:
        """Those without a ceiling that somebody uses, and those that somebody holds while requesting such a one."""
        used = {name for uses in self.protection.values() for name in uses.semaphores}
        found = used - {semaphore.name for semaphore in self.system.os.semaphores if semaphore.ceiling}
        while more := {name for name, inner in self.requests.items() if name not in found and not inner.isdisjoint(found)}:
            found |= more
        return frozenset(found)

    def unclear(self) -> Iterator[tuple[str, str]]:
        """The processes that can wait for an unknown time, and why."""
        open_semaphores = self.open_semaphores
        held_at_start = {semaphore.name for semaphore in self.system.os.semaphores if semaphore.initial_users > 0}
        in_circles = circles(self.requests, lambda name: self.requests.get(name, ()))
        circular = open_semaphores.intersection(set[str]().union(*in_circles))
        for name, uses in self.protection.items():
            for semaphore in sorted(uses.semaphores & held_at_start):
                yield name, f"the semaphore {semaphore!r} is already held when the system starts"
            for semaphore in sorted(uses.semaphores & circular):
                yield name, f"it can wait forever for the semaphore {semaphore!r}: semaphores are requested in different orders"
            for semaphore in sorted(uses.awaited_actively & open_semaphores):
                if sum(semaphore in other.semaphores for other in self.protection.values()) > 1:
                    yield (
                        name,
                        f"it waits actively for the semaphore {semaphore!r}, so that a holder of lower priority never runs",
                    )
