"""How long tasks of lower priority can hold up a task: regions that cannot be interrupted, and critical sections.

One region or one critical section at most is in the way under the immediate ceiling protocol (L. Sha, R. Rajkumar and J. Lehoczky,
"Priority inheritance protocols: an approach to real-time synchronization", IEEE Transactions on Computers 39(9), 1990).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros.analyze.demand import Demands
from amalthea_uros.analyze.notes import Notes
from amalthea_uros.analyze.placement import Placed
from amalthea_uros.perf.os import Semaphore
from amalthea_uros.perf.software import Activity, Call, Preemption, SemaphoreAccess, SemaphoreOperation, Task
from amalthea_uros.units import Time


def preemption(placed: Placed) -> Preemption:
    """Who can interrupt a process; interrupts always can, and nobody but them an interrupt service routine."""
    return placed.process.preemption if isinstance(placed.process, Task) else Preemption.PREEMPTIVE


def regions(placed: Placed, demands: Demands) -> list[Time]:
    """The stretches of a task that cooperative tasks cannot interrupt: all of it, or its runnables one by one."""
    match preemption(placed):
        case Preemption.NON_PREEMPTIVE:
            return [demands.cost(placed.process, placed.core).worst]
        case Preemption.COOPERATIVE:
            pieces = (Task(name=placed.process.name, activities=(a,)) for a in placed.process.activities)
            return [length for piece in pieces if (length := demands.cost(piece, placed.core).worst)]
    return []


def last_region(placed: Placed, demands: Demands) -> Time:
    """The shortest region with which a job can end: behind the last one that is executed each time others may not be."""
    found: list[Time] = []
    for activity in reversed(placed.process.activities):
        piece = demands.cost(Task(name=placed.process.name, activities=(activity,)), placed.core)
        if piece.worst:
            found.append(piece.worst)
        if any(part.prescaler == 1 and part.worst for part in piece.parts):
            break
    if preemption(placed) is Preemption.NON_PREEMPTIVE:
        return demands.cost(placed.process, placed.core).worst
    return min(found, default=0)


def blocking_times(placed: Sequence[Placed], demands: Demands, notes: Notes) -> Mapping[str, Time]:
    """The longest that each process of a core can wait for one of lower priority."""
    stretches = {item.process.name: max(regions(item, demands), default=0) for item in placed}
    sections = {item.process.name: list(_sections(item, demands)) for item in placed}
    ceilings: dict[str, tuple[bool, int]] = {}
    for item in placed:
        for name, _ in sections[item.process.name]:
            ceilings[name] = max(ceilings.get(name, item.rank), item.rank)
    _note_protocols(ceilings, demands, notes)
    found = {}
    for item in placed:
        lower = [other for other in placed if other.rank < item.rank]
        waits = [0]
        for other in lower:
            if _waits_for(item, other):
                waits.append(stretches[other.process.name])
            waits += [length for name, length in sections[other.process.name] if ceilings[name] >= item.rank]
        found[item.process.name] = max(waits)
    return found


def _waits_for(item: Placed, other: Placed) -> bool:
    """Whether a task waits for the region of a lower one; preemptive tasks interrupt cooperative ones at once."""
    if item.is_isr:
        return False
    return preemption(other) is Preemption.NON_PREEMPTIVE or preemption(item) is not Preemption.PREEMPTIVE


def _note_protocols(ceilings: Mapping[str, tuple[bool, int]], demands: Demands, notes: Notes) -> None:
    semaphores: Mapping[str, Semaphore] = {s.name: s for s in demands.system.os.semaphores}
    for name in ceilings:
        semaphore = semaphores.get(name)
        if semaphore is not None and not semaphore.ceiling:
            message = f"the semaphore {name!r} has no priority ceiling; it is analysed as if it had one"
            notes.warning("ANA003", message, semaphore)


def has_sections(placed: Placed, demands: Demands) -> bool:
    """Whether a process has critical sections."""
    return any(isinstance(activity, SemaphoreAccess) for activity in _flat(placed.process.activities, demands))


def _sections(placed: Placed, demands: Demands) -> Iterator[tuple[str, Time]]:
    """The critical sections of a process: semaphore, and how long it is held at most."""
    held: dict[str, list[Activity]] = {}
    for activity in _flat(placed.process.activities, demands):
        if isinstance(activity, SemaphoreAccess):
            if activity.operation is not SemaphoreOperation.RELEASE:
                held.setdefault(activity.semaphore, [])
            elif activity.semaphore in held:
                inside = held.pop(activity.semaphore)
                yield activity.semaphore, demands.cost(Task(name="", activities=tuple(inside)), placed.core).worst
        else:
            for inside in held.values():
                inside.append(activity)
    for name in held:
        # Never released: held until the end of the job.
        yield name, demands.cost(placed.process, placed.core).worst


def _flat(activities: Sequence[Activity], demands: Demands, above: tuple[str, ...] = ()) -> Iterator[Activity]:
    """The activities of a process with those of the runnables that it calls, as far as semaphores are involved."""
    for activity in activities:
        runnable = demands.system.runnables.get(activity.runnable) if isinstance(activity, Call) else None
        if runnable is not None and runnable.name not in above and _locks(runnable.activities):
            yield from _flat(runnable.activities, demands, (*above, runnable.name))
        else:
            yield activity


def _locks(activities: Sequence[Activity]) -> bool:
    return any(isinstance(activity, SemaphoreAccess) for activity in activities)
