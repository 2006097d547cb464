"""What INCHRON's importer am2inc will not take over of what the author asked for.

The rules are those of its source as of 2024-12; each is told once, with the objects that it concerns. They do not make a model wrong:
every other tool, and this one, takes what is lost there into account.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from amalthea_uros.perf.constraints import LatencyConstraint
from amalthea_uros.perf.distributions import Beta
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Execute, Preemption, walk
from amalthea_uros.perf.system import System
from amalthea_uros.uros.notes import Notes

_LONGEST_LIST = 5


def _requirements(system: System) -> Iterable[Named]:
    return system.constraints.requirements


def _other_constraints(system: System) -> Iterable[Named]:
    return (item for item in system.constraints.constraints if not isinstance(item, LatencyConstraint))


def _without_maximum(system: System) -> Iterable[Named]:
    return (c for c in system.constraints.constraints if isinstance(c, LatencyConstraint) and c.maximum is None)


def _other_policies(system: System) -> Iterable[Named]:
    return (s for s in system.schedulers.values() if s.policy != Policy.FIXED_PRIORITY_PREEMPTIVE)


def _cooperative(system: System) -> Iterable[Named]:
    return (task for task in system.software.tasks if task.preemption is Preemption.COOPERATIVE)


def _resources(system: System) -> Iterable[Named]:
    return system.os.semaphores


def _accesses(system: System) -> Iterable[Named]:
    return (core for core in system.cores.values() if core.accesses)


def _beta(system: System) -> Iterator[Named]:
    for runnable in system.software.runnables:
        if any(isinstance(a, Execute) and isinstance(a.demand.ticks, Beta) for a in walk(runnable.activities)):
            yield runnable


def _by_core_type(system: System) -> Iterator[Named]:
    for runnable in system.software.runnables:
        if any(isinstance(a, Execute) and a.demand.by_core_type for a in walk(runnable.activities)):
            yield runnable


#: Rule, which objects it concerns, what happens to them.
_LOSSES: tuple[tuple[str, Callable[[System], Iterable[Named]], str], ...] = (
    ("INC-CO-KIND", _requirements, "requirements are dropped"),
    ("INC-CO-KIND", _other_constraints, "constraints other than latencies of event chains are dropped"),
    ("INC-LC-MAX", _without_maximum, "a latency without a maximum gets the limit 0"),
    ("INC-OS-ALGORITHM", _other_policies, "every scheduler becomes one of fixed priorities with preemption"),
    ("INC-SW-PREEMPTION", _cooperative, "cooperative tasks become non-preemptive"),
    ("INC-OS-SEMA-TYPE", _resources, "resources lose their kind and the priority ceiling"),
    ("INC-HW-ACCESS", _accesses, "the cost of memory accesses is lost"),
    ("INC-SW-TICKS-BETA", _beta, "a beta distribution becomes its upper bound"),
    ("INC-SW-TICKS-DEFAULT", _by_core_type, "execution times that depend on the core type are read as one of them"),
)


def note_losses(system: System, notes: Notes) -> None:
    """Note what gets lost."""
    for rule, select, what in _LOSSES:
        concerned = list(select(system))
        if concerned:
            some = ", ".join(item.name for item in concerned[:_LONGEST_LIST])
            more = f" and {len(concerned) - _LONGEST_LIST} more" if len(concerned) > _LONGEST_LIST else ""
            notes.info(rule, f"for INCHRON's importer am2inc: {what} ({some}{more})", concerned[0].origin)
