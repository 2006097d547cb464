"""A route through a chain as stages: what each job contributes, from the moment at which it reads to the one at which it writes."""

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
    """Where what a job writes can be read: from its end on, from the position itself, or from the end of its period."""

    communication: Communication
    position: ActivityPosition | None


@dataclass(frozen=True, slots=True)
class Fire:
    """Where a job triggers another process."""

    position: ActivityPosition | None


@dataclass(frozen=True, slots=True)
class At:
    """An event at which the chain starts or ends; under logical execution times its job's release, and the end of its period."""

    occurrence: EventOccurrence
    communication: Communication
    is_end: bool


Moment = Read | Write | Fire | At


@dataclass(frozen=True, slots=True)
class Stage:
    """The part of a chain within the jobs of a process.

    Attributes
    ----------
    is_triggered : whether the stage before activates it
    """

    process: Process
    enter: Moment
    leave: Moment
    is_triggered: bool = False

    @property
    def positions(self) -> list[ActivityPosition]:
        """Where the jobs have to come."""
        found = [
            moment.occurrence.position if isinstance(moment, At) else moment.position for moment in (self.enter, self.leave)
        ]
        return [position for position in found if position is not None]

    @property
    def counters(self) -> set[Counter]:
        """What lets only some jobs take part."""
        return {counter for position in self.positions for counter in position.counters}


def stages(route: Route, communication: Communication | None) -> list[Stage]:
    """The stages of a route.

    Parameters
    ----------
    communication : instead of what the accesses say; None: as they say, and implicit where they say nothing
    """
    how = communication or Communication.IMPLICIT
    found: list[Stage] = []
    enter: Moment = At(route.occurrences[0], how, is_end=False)
    is_triggered = False
    for link, before in zip(route.links, route.occurrences, strict=False):
        if link.kind is LinkKind.JOB:
            continue
        leave = Fire(link.write) if link.kind is LinkKind.TRIGGER else Write(_stated(link.write, communication), link.write)
        found.append(Stage(before.process, enter, leave, is_triggered))
        is_triggered = link.kind is LinkKind.TRIGGER
        enter = Read(_stated(link.read, communication), link.read)
    last = route.occurrences[-1]
    found.append(Stage(last.process, enter, At(last, how, is_end=True), is_triggered))
    return found


def _stated(position: ActivityPosition | None, communication: Communication | None) -> Communication:
    access = position.activity if position is not None else None
    stated = access.communication if isinstance(access, LabelAccess) else None
    return communication or stated or Communication.IMPLICIT


def communication_of(found: Iterable[Stage]) -> str:
    """How stages communicate, in a word."""
    moments = [moment for stage in found for moment in (stage.enter, stage.leave)]
    stated = {moment.communication for moment in moments if isinstance(moment, Read | Write)}
    ends = {moment.communication for moment in moments if isinstance(moment, At)}
    kinds = stated or ends
    return str(next(iter(kinds))).lower() if len(kinds) == 1 else "mixed"


def hop_text(link: Link) -> str:
    """How a link is told."""
    return f"{link.kind} {', '.join(link.names)}".strip()
