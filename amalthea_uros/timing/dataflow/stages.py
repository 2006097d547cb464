"""A route through a chain as stages: the part that each job contributes, from its read to its write.

If counters let different jobs of a process reach two positions, the effect waits at the first one for a job that reaches the other
one. So these are two stages, although they belong to the same process.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.perf.activities import Communication, Group
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.dataflow.events import EventOccurrence, JobPhase
from amalthea_uros.timing.dataflow.links import Link, LinkKind, communication_of
from amalthea_uros.timing.dataflow.routes import Route
from amalthea_uros.timing.jobs.counters import ALWAYS
from amalthea_uros.timing.jobs.positions import ActivityPosition


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


@dataclass(frozen=True, slots=True)
class Pass:
    """Where a job passes the effect on within its process: to a later position of the same job, or to a later job."""


Boundary = Read | Write | Fire | At | Pass


@dataclass(frozen=True, slots=True)
class JobsLater:
    """After how many jobs of a process, at least and at most, a later stage in it uses what a job passes on."""

    least: int
    most: int


SAME_JOB, NEXT_JOB, SAME_OR_NEXT_JOB = JobsLater(0, 0), JobsLater(1, 1), JobsLater(0, 1)


@dataclass(frozen=True, slots=True)
class Stage:
    """The part of a chain within the jobs of a process.

    Attributes
    ----------
    enter, leave : the boundaries of that part
    positions : those that a job must reach to take part
    is_triggered : whether the previous stage activates it
    jobs_later : how the next stage gets the output, if it belongs to the same process
    """

    process: Process
    enter: Boundary
    leave: Boundary
    positions: tuple[ActivityPosition, ...] = ()
    is_triggered: bool = False
    jobs_later: JobsLater | None = None

    @property
    def counter(self) -> Counter | None:
        """The counter that lets only some jobs take part, the same at all positions of a stage; None if it is unknown."""
        return self.positions[0].counter if self.positions else ALWAYS


def stages(route: Route, communication: Communication | None) -> list[Stage]:
    """The stages of a route.

    Parameters
    ----------
    communication : overrides that of the accesses; None: as modelled, implicit by default
    """
    how = communication or Communication.IMPLICIT
    found: list[Stage] = []
    enter: Boundary = At(route.occurrences[0], how, is_end=False)
    is_triggered, passed = False, [route.occurrences[0].position]
    for link, (before, then) in zip(route.links, pairwise(route.occurrences), strict=True):
        if link.kind is LinkKind.JOB:
            passed.append(then.position)
            continue
        is_trigger = link.kind in (LinkKind.TRIGGER, LinkKind.RELAY)
        write, read = (communication_of(position, communication) for position in (link.write, link.read))
        leave = Fire(link.write, link.is_before) if is_trigger else Write(write, link.write)
        is_same = before.process.name == then.process.name and not is_trigger
        later = _jobs_later(link, write, read) if is_same else None
        if later == SAME_JOB and then.order < before.order:
            # What the data reach in the same job comes before the event.
            later = NEXT_JOB
        if later == NEXT_JOB and before.when is JobPhase.END and then.position is not None:
            # What the same job does at the instant of its end may be meant.
            later = SAME_OR_NEXT_JOB
        if _has_left_before(enter, leave):
            # What the job has sent before the event does not come from it: the next job sends. The effect of what it has sent may be
            # meant nevertheless if that comes after the event, so that no minimum relies on the next job.
            found.append(Stage(before.process, enter, Pass(), jobs_later=SAME_OR_NEXT_JOB))
            enter = Pass()
        found += _within(
            Stage(before.process, enter, leave, is_triggered=is_triggered, jobs_later=later), [*passed, link.write]
        )
        is_triggered, passed = is_trigger, [link.read, then.position]
        enter = Read(read, link.read)
    last = route.occurrences[-1]
    return found + _within(Stage(last.process, enter, At(last, how, is_end=True), is_triggered=is_triggered), passed)


def _has_left_before(enter: Boundary, leave: Boundary) -> bool:
    """Whether a stage begins with the end of a job that leaves it before its end."""
    if not isinstance(enter, At) or enter.communication is Communication.LET or enter.occurrence.when is not JobPhase.END:
        return False
    match leave:
        case Fire(position=ActivityPosition()) | Write(communication=Communication.EXPLICIT, position=ActivityPosition()):
            return True
    return False


def _within(stage: Stage, passed: Sequence[ActivityPosition | None]) -> list[Stage]:
    """A stage, divided where different jobs reach the positions that it passes, or the order of these is uncertain."""
    parts: list[list[ActivityPosition]] = [[]]
    links: list[JobsLater] = []
    for position in passed:
        if position is None:
            continue
        if parts[-1]:
            before = parts[-1][-1]
            later = _later_in_job(before, position)
            if later != SAME_JOB or before.counter != position.counter:
                parts.append([])
                links.append(later)
        parts[-1].append(position)
    last = len(parts) - 1
    return [
        replace(
            stage,
            enter=Pass() if number else stage.enter,
            leave=stage.leave if number == last else Pass(),
            positions=tuple(part),
            is_triggered=stage.is_triggered and not number,
            jobs_later=stage.jobs_later if number == last else links[number],
        )
        for number, part in enumerate(parts)
    ]


def _later_in_job(first: ActivityPosition, then: ActivityPosition) -> JobsLater:
    """How the effect gets from one position of a process to another one that is meant to be later in the job."""
    return SAME_JOB if first.number <= then.last and _is_order_certain(first, then) else SAME_OR_NEXT_JOB


def _jobs_later(link: Link, write: Communication, read: Communication) -> JobsLater | None:
    """How data get from a job to another part of its own process; None if the times of both decide."""
    logical = {write, read} & {Communication.LET}
    if logical:
        return NEXT_JOB if write is read else None
    if link.write is None or link.read is None:
        return NEXT_JOB
    if link.write.is_certain and link.read.is_certain:
        # Within a job the data flow directly, also between accesses that are implicit.
        return NEXT_JOB if link.read.number < link.write.number else SAME_JOB
    return SAME_OR_NEXT_JOB


def _is_order_certain(first: ActivityPosition, then: ActivityPosition) -> bool:
    """Whether the order of two positions is the same in all jobs."""
    container = None
    for (activities, index), (others, other) in zip(first.outer, then.outer, strict=False):
        if activities is not others:
            return False
        if index != other:
            return not isinstance(container, Group) or container.ordered
        container = activities[index]
    return True


def common_communication(found: Iterable[Stage]) -> str:
    """How stages communicate, in one word."""
    boundaries = [boundary for stage in found for boundary in (stage.enter, stage.leave)]
    stated = {boundary.communication for boundary in boundaries if isinstance(boundary, Read | Write)}
    ends = {boundary.communication for boundary in boundaries if isinstance(boundary, At)}
    kinds = stated or ends
    return str(next(iter(kinds))).lower() if len(kinds) == 1 else "mixed"
