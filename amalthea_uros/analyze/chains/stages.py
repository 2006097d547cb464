"""A route through a chain as stages: the part that each job contributes, from its read to its write."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from amalthea_uros.perf.software import Communication, LabelAccess, Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.dataflow.events import EventOccurrence
from amalthea_uros.timing.dataflow.links import Link, LinkKind
from amalthea_uros.timing.dataflow.positions import ActivityPosition
from amalthea_uros.timing.dataflow.routes import Route


@dataclass(frozen=True, slots=True)
class Read:
    """Where a job reads: at its start, at the position itself, or at its release."""

    communication: Communication
    position: ActivityPosition | None


@dataclass(frozen=True, slots=True)
class Write:
    """Where the data written by a job become visible: at its end, at the position itself, or at the end of its period."""

    communication: Communication
    position: ActivityPosition | None


@dataclass(frozen=True, slots=True)
class Fire:
    """Where a job triggers another process: at the end of an activity, or at its start."""

    position: ActivityPosition | None
    is_before: bool = False


@dataclass(frozen=True, slots=True)
class At:
    """An event at which the chain starts or ends; under LET, the release of its job or the end of the period."""

    occurrence: EventOccurrence
    communication: Communication
    is_end: bool


Boundary = Read | Write | Fire | At


@dataclass(frozen=True, slots=True)
class Stage:
    """The part of a chain within the jobs of a process.

    Attributes
    ----------
    enter, leave : the boundaries of that part
    is_triggered : whether the previous stage activates it
    """

    process: Process
    enter: Boundary
    leave: Boundary
    is_triggered: bool = False

    @property
    def positions(self) -> list[ActivityPosition]:
        """The positions that a job must reach to take part."""
        found = [
            boundary.occurrence.position if isinstance(boundary, At) else boundary.position
            for boundary in (self.enter, self.leave)
        ]
        return [position for position in found if position is not None]

    @property
    def counters(self) -> set[Counter]:
        """The counters that let only some jobs take part."""
        return {position.counter for position in self.positions if position.counter is not None}

    @property
    def is_countable(self) -> bool:
        """Whether the counters are those of its process alone, so that it is known how often its jobs take part."""
        return all(position.counter is not None for position in self.positions)


def stages(route: Route, communication: Communication | None) -> list[Stage]:
    """The stages of a route.

    Parameters
    ----------
    communication : overrides that of the accesses; None: as modelled, implicit by default
    """
    how = communication or Communication.IMPLICIT
    found: list[Stage] = []
    enter: Boundary = At(route.occurrences[0], how, is_end=False)
    is_triggered = False
    for link, before in zip(route.links, route.occurrences, strict=False):
        if link.kind is LinkKind.JOB:
            continue
        leave = (
            Fire(link.write, link.is_before)
            if link.kind is LinkKind.TRIGGER
            else Write(_communication(link.write, communication), link.write)
        )
        found.append(Stage(before.process, enter, leave, is_triggered))
        is_triggered = link.kind is LinkKind.TRIGGER
        enter = Read(_communication(link.read, communication), link.read)
    last = route.occurrences[-1]
    found.append(Stage(last.process, enter, At(last, how, is_end=True), is_triggered))
    return found


def _communication(position: ActivityPosition | None, communication: Communication | None) -> Communication:
    access = position.activity if position is not None else None
    stated = access.communication if isinstance(access, LabelAccess) else None
    return communication or stated or Communication.IMPLICIT


def communication_of(found: Iterable[Stage]) -> str:
    """How stages communicate, in one word."""
    boundaries = [boundary for stage in found for boundary in (stage.enter, stage.leave)]
    stated = {boundary.communication for boundary in boundaries if isinstance(boundary, Read | Write)}
    ends = {boundary.communication for boundary in boundaries if isinstance(boundary, At)}
    kinds = stated or ends
    return str(next(iter(kinds))).lower() if len(kinds) == 1 else "mixed"


def link_text(link: Link) -> str:
    """A link in words."""
    return f"{link.kind} {', '.join(link.names)}".strip()
