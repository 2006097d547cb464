"""The overhead that a description states for the jobs of a process."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.design.description.owners import Owner, OwnerKind, owners
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.spec.description import Description
from amalthea_uros.units import Time
from amalthea_uros.uros.assembly.demand import times_of

_KINDS = (
    OwnerKind.EXECUTOR,
    OwnerKind.TIMER,
    OwnerKind.MESSAGE_CALLBACK,
    OwnerKind.TASK,
    OwnerKind.ISR,
    OwnerKind.INTERRUPT,
)


def with_overhead(description: Description) -> Iterator[Owner]:
    """The sections that can state an overhead."""
    return (owner for owner in owners(description) if owner.kind in _KINDS)


def stated_overhead(process: str, description: Description) -> tuple[Time, Time] | None:
    """The least and the greatest overhead of a job of a process; None if none is stated.

    An explicit zero is a statement, too.
    """
    owner = next((owner for owner in with_overhead(description) if owner.name == process), None)
    if owner is None:
        return None
    common, own = description.os.overhead, getattr(owner.section, "overhead", None)
    default = common.isr if owner.kind in (OwnerKind.ISR, OwnerKind.INTERRUPT) else common
    stated = (getattr(own, part, None) or getattr(default, part) for part in ("activation", "termination"))
    known = [times_of(time) for time in stated if time is not None]
    if not known:
        return None
    return sum(round(lowest(time) or 0) for time in known), sum(round(highest(time) or 0) for time in known)
