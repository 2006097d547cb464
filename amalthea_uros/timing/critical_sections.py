"""Critical sections of processes: the semaphores, and the activities executed while they are held."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.perf.software import Activity, Call, Process, SemaphoreAccess, SemaphoreOperation
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.positions import ActivityPosition


def critical_sections(process: Process, system: System) -> Iterator[tuple[str, Sequence[Activity]]]:
    """The critical sections of a process: semaphore, and the activities executed while it is held."""
    held: dict[str, list[Activity]] = {}
    for activity in _flat(process.activities, system):
        if isinstance(activity, SemaphoreAccess):
            if activity.operation is not SemaphoreOperation.RELEASE:
                held.setdefault(activity.semaphore, [])
            elif activity.semaphore in held:
                yield activity.semaphore, held.pop(activity.semaphore)
        else:
            for inside in held.values():
                inside.append(activity)
    for name in held:
        # Never released: held until the end of the job.
        yield name, process.activities


def semaphores_of(process: Process, system: System) -> set[str]:
    """The semaphores that a process uses."""
    found = _flat(process.activities, system)
    return {activity.semaphore for activity in found if isinstance(activity, SemaphoreAccess)}


def _flat(activities: Sequence[Activity], system: System, above: tuple[str, ...] = ()) -> Iterator[Activity]:
    """The activities of a process; calls of runnables that use semaphores are replaced by their activities."""
    for activity in activities:
        runnable = system.runnables.get(activity.runnable) if isinstance(activity, Call) else None
        if runnable is not None and runnable.name not in above and _locks(runnable.activities):
            yield from _flat(runnable.activities, system, (*above, runnable.name))
        else:
            yield activity


def _locks(activities: Sequence[Activity]) -> bool:
    return any(isinstance(activity, SemaphoreAccess) for activity in activities)


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
