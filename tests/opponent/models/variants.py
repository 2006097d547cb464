"""What a model leaves open: how to read it, and the choices of one play."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import dropwhile, product
from random import Random
from typing import Any

from opponent.models.reading import Body, Item, Played, Process


class Points(StrEnum):
    """The points at which a cooperative task can be preempted."""

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
class Variant:
    """One reading of each open point.

    Attributes
    ----------
    ends_late : what follows an execution waits for the core if somebody arrives at its end; else it is done before
    end_waits : also the end of the job waits for the core after a trigger, release or schedule point
    accesses_last : a job that has only accesses of labels left ends at once, before more urgent jobs that it has activated
    last_first : at one instant, what is declared last comes first, also of equals
    nominal_deadlines : deadlines count from the release without jitter
    serial_isrs : interrupt service routines do not preempt each other
    unmasked : interrupts come also within non-interruptible groups
    fresh_slice : a slice starts anew after a preemption
    requeue_late : who used up its slice queues behind who arrives at that instant
    fires_first : an activation takes effect before its overhead
    decides_below : decisions of schedulers do not keep interrupts off
    decides_outside : the decision at the end of a job is no part of it
    polls_early : a polling server looks for work before what arrives at that instant
    """

    points: Points = Points.SCHEDULE_POINTS
    intruders: Intruders = Intruders.PREEMPTIVE
    handover: Handover = Handover.URGENT
    ceilings: Ceilings = Ceilings.START
    ends_late: bool = False
    end_waits: bool = False
    accesses_last: bool = False
    last_first: bool = False
    nominal_deadlines: bool = False
    serial_isrs: bool = False
    unmasked: bool = False
    fresh_slice: bool = False
    requeue_late: bool = False
    fires_first: bool = False
    decides_below: bool = False
    decides_outside: bool = False
    polls_early: bool = False


ACCESSES = ("read", "write")
#: Items after which the end of a job can wait for the core.
END_WAITS_AFTER = {"trigger", "release", "point"}


def variants_of(played: Played) -> list[Variant]:
    """All readings that matter to a model."""
    open_points = {name: values for name, (matters, values) in _open_points(played).items() if matters}
    return [Variant(**dict(zip(open_points, chosen, strict=True))) for chosen in product(*open_points.values())]


def _open_points(played: Played) -> dict[str, tuple[bool, Iterable[Any]]]:
    """The fields of a variant: whether they matter, and their values."""
    either = (False, True)
    isrs = [process for process in played.processes if process.is_isr]
    tasks = [process for process in played.processes if not process.is_isr]
    items = list(items_of(played))
    kinds = {item[0] for item in items}
    has_slices = any("RoundRobin" in policy for policy in played.policies.values())
    has_deadlines = any("EarliestDeadline" in policy for policy in played.policies.values())
    cooperative = [process for process in tasks if process.mode == "cooperative"]
    return {
        "points": (bool(cooperative) and "call" in kinds, Points),
        "intruders": (bool(cooperative) and len({task.mode for task in tasks}) > 1, Intruders),
        "handover": (not all(played.semaphores.values()), Handover),
        "ceilings": (has_deadlines and any(played.semaphores.values()), Ceilings),
        "nominal_deadlines": (has_deadlines and any("jitter" in s.given for s in played.stimuli.values()), either),
        "accesses_last": (any(map(_ends_with_accesses, played.processes)), either),
        "ends_late": (True, either),
        "end_waits": (bool(kinds & END_WAITS_AFTER), either),
        "last_first": (True, either),
        "serial_isrs": (len({p.core for p in isrs}) < len(isrs), either),
        "unmasked": (bool(isrs) and any(item[0] == "group" and not item[3] for item in items), either),
        "fresh_slice": (has_slices, either),
        "requeue_late": (has_slices, either),
        "fires_first": ("apiOverhead/apiActivateTask" in played.overhead, either),
        "decides_below": (bool(played.decisions) and bool(isrs), either),
        "decides_outside": (bool(played.decisions), either),
        "polls_early": (any("Polling" in server.policy for server in played.servers.values()), either),
    }


def _ends_with_accesses(process: Process) -> bool:
    """Whether a body ends with accesses that do not directly follow an execution."""
    kinds = [item[0] for item in process.body]
    rest = list(dropwhile(lambda kind: kind in ACCESSES, reversed(kinds)))
    return 0 < len(rest) < len(kinds) and rest[0] != "execute"


def items_of(played: Played) -> Iterator[tuple[Any, ...]]:
    """All items of a model."""
    for body in (*(process.body for process in played.processes), *(body for body, _ in played.runnables.values())):
        yield from _inside(body)


def _inside(body: Body) -> Iterator[tuple[Any, ...]]:
    for item in body:
        yield item
        inner = (
            [item[1]] if item[0] == "group" else [branch for _, branch in item[1]] if item[0] in ("switch", "chance") else []
        )
        inner += [item[2]] if item[0] == "switch" else []
        for part in inner:
            yield from _inside(part)


def items_of_process(played: Played, process: str) -> Iterator[Item]:
    """All items that a process can reach."""
    bodies = [next(p.body for p in played.processes if p.name == process)]
    known: set[str] = set()
    while bodies:
        alone = Played(
            **{f: getattr(played, f) for f in played.__slots__} | {"processes": (), "runnables": {"": (bodies.pop(), ())}}
        )
        for item in items_of(alone):
            yield item
            if item[0] == "call" and item[1] not in known:
                known.add(item[1])
                bodies.append(played.runnables[item[1]][0])


class Choices:
    """What is left to chance in one play: all least, all greatest, extremes, or anything."""

    def __init__(self, seed: int) -> None:
        self.rng = Random(seed)
        styles = ("worst", "best", "corners", "any")
        self.style = styles[seed] if seed < len(styles) else self.rng.choice(styles)

    def between(self, least: int, most: int, *, early: bool = False) -> int:
        """A value between two others; `early`: the least one is the worst."""
        if self.style in ("best", "worst"):
            return most if (self.style == "worst") != early else least
        if self.style == "corners" or self.rng.random() < 0.5:
            return self.rng.choice((least, most))
        return self.rng.randint(least, most)
