"""A route through a chain as stages: what each job contributes, from the moment at which it reads to the one at which it writes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from amalthea_uros.perf.software import Communication, LabelAccess, Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.dataflow.events import Spot
from amalthea_uros.timing.dataflow.links import Carrier, Hop, Route
from amalthea_uros.timing.dataflow.positions import Place


@dataclass(frozen=True, slots=True)
class Read:
    """Where a job reads: at its start, at the place itself, or at its release."""

    communication: Communication
    place: Place | None


@dataclass(frozen=True, slots=True)
class Write:
    """Where what a job writes can be read: from its end on, from the place itself, or from the end of its period."""

    communication: Communication
    place: Place | None


@dataclass(frozen=True, slots=True)
class Fire:
    """Where a job triggers another process."""

    place: Place | None


@dataclass(frozen=True, slots=True)
class At:
    """An event at which the chain starts or ends; under logical execution times its job's release, and the end of its period."""

    spot: Spot
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
    def places(self) -> list[Place]:
        """Where the jobs have to come."""
        found = [moment.spot.place if isinstance(moment, At) else moment.place for moment in (self.enter, self.leave)]
        return [place for place in found if place is not None]

    @property
    def counters(self) -> set[Counter]:
        """What lets only some jobs take part."""
        return {counter for place in self.places for counter in place.counters}


def stages(route: Route, communication: Communication | None) -> list[Stage]:
    """The stages of a route.

    Parameters
    ----------
    communication : instead of what the accesses say; None: as they say, and implicit where they say nothing
    """
    how = communication or Communication.IMPLICIT
    found: list[Stage] = []
    enter: Moment = At(route.spots[0], how, is_end=False)
    is_triggered = False
    for hop, before in zip(route.hops, route.spots, strict=False):
        if hop.carrier is Carrier.JOB:
            continue
        leave = Fire(hop.write) if hop.carrier is Carrier.TRIGGER else Write(_stated(hop.write, communication), hop.write)
        found.append(Stage(before.process, enter, leave, is_triggered))
        is_triggered = hop.carrier is Carrier.TRIGGER
        enter = Read(_stated(hop.read, communication), hop.read)
    last = route.spots[-1]
    found.append(Stage(last.process, enter, At(last, how, is_end=True), is_triggered))
    return found


def _stated(place: Place | None, communication: Communication | None) -> Communication:
    access = place.activity if place is not None else None
    stated = access.communication if isinstance(access, LabelAccess) else None
    return communication or stated or Communication.IMPLICIT


def communication_of(found: Iterable[Stage]) -> str:
    """How stages communicate, in a word."""
    moments = [moment for stage in found for moment in (stage.enter, stage.leave)]
    stated = {moment.communication for moment in moments if isinstance(moment, Read | Write)}
    ends = {moment.communication for moment in moments if isinstance(moment, At)}
    kinds = stated or ends
    return str(next(iter(kinds))).lower() if len(kinds) == 1 else "mixed"


def hop_text(hop: Hop) -> str:
    """How a hop is told."""
    return f"{hop.carrier} {', '.join(hop.names)}".strip()
