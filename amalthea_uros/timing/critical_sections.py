"""Critical sections of processes: which semaphores they hold, and what they execute meanwhile."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.perf.software import Activity, Call, Process, SemaphoreAccess, SemaphoreOperation
from amalthea_uros.perf.system import System


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
    """The activities of a process; calls of runnables that use semaphores are replaced by the activities of these."""
    for activity in activities:
        runnable = system.runnables.get(activity.runnable) if isinstance(activity, Call) else None
        if runnable is not None and runnable.name not in above and _locks(runnable.activities):
            yield from _flat(runnable.activities, system, (*above, runnable.name))
        else:
            yield activity


def _locks(activities: Sequence[Activity]) -> bool:
    return any(isinstance(activity, SemaphoreAccess) for activity in activities)
