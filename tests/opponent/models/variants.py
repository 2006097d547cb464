"""What a model leaves open: how to read it, and the choices of one play."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import dropwhile, product
from random import Random
from typing import Any

from opponent.models.reading import Body, Item, Played, Process


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """One reading of each open point.

    Attributes
    ----------
    ends_late : what follows an execution waits for the core if somebody arrives at its end; else it is done before
    last_first : at one instant, what is declared last comes first, also of equals
    serial_isrs : interrupt service routines do not preempt each other
    unmasked : interrupts come also within non-interruptible groups
    fresh_slice : a slice starts anew after a preemption
    requeue_late : who used up its slice queues behind who arrives at that instant
    fires_first : an activation takes effect before its overhead
    decides_below : decisions of schedulers do not keep interrupts off
    decides_outside : the decision at the end of a job is no part of it
    polls_early : a polling server looks for work before what arrives at that instant
    points_at_calls : cooperative tasks can be preempted after calls, too
    whole_cooperative : cooperative tasks keep off all tasks between these points, not only cooperative ones
    accesses_last : a job that has only accesses of labels left ends at once, before more urgent jobs that it has activated
    """

    ends_late: bool = False
    last_first: bool = False
    serial_isrs: bool = False
    unmasked: bool = False
    fresh_slice: bool = False
    requeue_late: bool = False
    fires_first: bool = False
    decides_below: bool = False
    decides_outside: bool = False
    polls_early: bool = False
    points_at_calls: bool = False
    whole_cooperative: bool = False
    accesses_last: bool = False


ACCESSES = ("read", "write")


def variants_of(played: Played) -> list[Variant]:
    """All readings that matter to a model."""
    open_points = [name for name, matters in _open_points(played).items() if matters]
    choices = product((False, True), repeat=len(open_points))
    return [Variant(**dict(zip(open_points, chosen, strict=True))) for chosen in choices]


def _open_points(played: Played) -> dict[str, bool]:
    isrs = [process for process in played.processes if process.is_isr]
    items = list(items_of(played))
    has_slices = any("RoundRobin" in policy for policy in played.policies.values())
    cooperative = [process for process in played.processes if process.mode == "cooperative"]
    return {
        "points_at_calls": any(item[0] == "call" for p in cooperative for item in p.body),
        "whole_cooperative": bool(cooperative),
        "accesses_last": any(map(_ends_with_accesses, played.processes)),
        "ends_late": True,
        "last_first": True,
        "serial_isrs": len({p.core for p in isrs}) < len(isrs),
        "unmasked": bool(isrs) and any(item[0] == "group" and not item[3] for item in items),
        "fresh_slice": has_slices,
        "requeue_late": has_slices,
        "fires_first": "apiOverhead/apiActivateTask" in played.overhead,
        "decides_below": bool(played.decisions) and bool(isrs),
        "decides_outside": bool(played.decisions),
        "polls_early": any("Polling" in server.policy for server in played.servers.values()),
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
