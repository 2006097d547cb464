"""What a model leaves open about scheduling: the readings, and which of them matter to a system."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from itertools import product
from typing import Any

from opponent.systems import PlainSystem, items_of


class Instant(StrEnum):
    """What happens where an execution ends at the instant at which somebody else arrives."""

    BEFORE = "what follows is done before"
    AFTER = "what follows is done when the core is had again"
    BEFORE_WITH_ACCESSES = "what follows is done before, and nobody comes between an access and what it follows"
    END_WAITS = "also the end of the job waits for the core after a trigger, release or schedule point"


class Points(StrEnum):
    """Where a cooperative task yields."""

    SCHEDULE_POINTS = "schedule points"
    TOP_CALLS = "also after calls at the top of its body"
    CALLS = "also after all calls"


class Intruders(StrEnum):
    """Who interrupts a cooperative task elsewhere."""

    NOBODY = "no task"
    PREEMPTIVE = "tasks that are not cooperative"
    ABOVE_THEM = "also cooperative tasks above them"


class Handover(StrEnum):
    """Who gets a semaphore for which several wait."""

    URGENT = "the most urgent"
    FIRST = "the first come"
    AGAIN = "all try again"


class Ceilings(StrEnum):
    """What a ceiling means under earliest deadline first."""

    START = "jobs start if their relative deadline is below all ceilings"
    DEADLINE = "the deadline of the holder is shortened"
    NONE = "mutual exclusion only"


@dataclass(frozen=True, slots=True, kw_only=True)
class Readings:
    """One reading of each open point; `last_first`, `nominal_deadlines` and the others that are no choice of a list are yes or no.

    Attributes
    ----------
    last_first : of equals that are released at one instant, the one declared last goes first
    nominal_deadlines : deadlines count from the release without jitter
    masked : interrupts are kept off by non-interruptible groups
    serial_isrs : interrupt service routines do not preempt each other
    fresh_slice : a slice starts anew after a preemption
    requeue_late : who used up its slice queues behind who arrives at that instant
    let_execution : a chain under LET starts and ends with the execution of jobs
    """

    instant: Instant = Instant.BEFORE
    last_first: bool = False
    points: Points = Points.SCHEDULE_POINTS
    intruders: Intruders = Intruders.NOBODY
    handover: Handover = Handover.URGENT
    ceilings: Ceilings = Ceilings.START
    nominal_deadlines: bool = False
    masked: bool = True
    serial_isrs: bool = False
    fresh_slice: bool = False
    requeue_late: bool = False


def readings_of(system: PlainSystem) -> list[Readings]:
    """All readings that matter to a system."""
    open_points = _open_points(system)
    return [Readings(**dict(zip(open_points, chosen, strict=True))) for chosen in product(*open_points.values())]


def _open_points(system: PlainSystem) -> dict[str, list[Any]]:
    """The fields of `Readings` that matter, with all their values."""
    cores, semaphores = system["cores"], system["semaphores"].values()
    tasks = [process for process in system["processes"] if process["kind"] == "task"]
    isrs = [process for process in system["processes"] if process["kind"] == "isr"]
    items = items_of(system)
    is_edf = "EDF" in cores.values()
    found: dict[str, list[Any]] = {"instant": [Instant.BEFORE, Instant.AFTER]}
    if any("trigger" in item or "point" in item for item in items):
        found["instant"] = list(Instant)
    if _have_equals(system):
        found["last_first"] = [False, True]
    cooperative = [task for task in tasks if task["preemption"] == "cooperative"]
    if cooperative and any("call" in item for item in items):
        found["points"] = list(Points)
    if cooperative and len({task["preemption"] for task in tasks}) > 1:
        found["intruders"] = list(Intruders)
    if not all(semaphore["ceiling"] for semaphore in semaphores):
        found["handover"] = list(Handover)
    if is_edf and any(semaphore["ceiling"] for semaphore in semaphores):
        found["ceilings"] = list(Ceilings)
    if is_edf and any("jitter" in process["arrival"].get("periodic", ()) for process in tasks):
        found["nominal_deadlines"] = [False, True]
    if isrs and any(not item.get("interruptible", True) for item in items):
        found["masked"] = [True, False]
    if any(sum(isr["core"] == core for isr in isrs) > 1 for core in cores):
        found["serial_isrs"] = [False, True]
    if "RR" in cores.values():
        found["fresh_slice"] = found["requeue_late"] = [False, True]
    return found


def _have_equals(system: PlainSystem) -> bool:
    """Whether two processes of a core can be equally urgent."""
    seen = set()
    for process in system["processes"]:
        is_edf = process["kind"] == "task" and system["cores"][process["core"]] == "EDF"
        key = (process["core"], process["kind"], "EDF" if is_edf else process["priority"])
        if key in seen:
            return True
        seen.add(key)
    return False
