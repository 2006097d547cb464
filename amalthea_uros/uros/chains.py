"""Event chains: paths of processes, functions and labels as events and their sequence."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf import events as perf
from amalthea_uros.perf.constraints import LatencyConstraint, LatencyKind
from amalthea_uros.spec.requirements import Chain, Moment
from amalthea_uros.uros.notes import Notes

_PROCESS_CHANGES: Mapping[Moment, perf.ProcessChange] = {
    "activation": perf.ProcessChange.ACTIVATE,
    "start": perf.ProcessChange.START,
    "finish": perf.ProcessChange.TERMINATE,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """Something that a path can lead through.

    Attributes
    ----------
    process : the process itself, or the one in which the function runs
    runnable : the function; None for a process
    reads, writes : labels
    activates : processes that it triggers
    sends, receives : topics, by which data leave and reach the controller
    """

    process: str | None
    runnable: str | None = None
    reads: frozenset[str] = frozenset()
    writes: frozenset[str] = frozenset()
    activates: frozenset[str] = frozenset()
    sends: frozenset[str] = frozenset()
    receives: frozenset[str] = frozenset()


@dataclass(slots=True)
class Chains:
    """Turns chains of the file into event chains; gathers their events.

    Attributes
    ----------
    members : by the name that a path uses
    labels : names of all labels
    """

    members: Mapping[str, Member]
    labels: frozenset[str]
    notes: Notes
    events: dict[str, perf.Event] = field(default_factory=dict)
    chains: dict[str, perf.EventChain] = field(default_factory=dict)
    _seen: set[str] = field(default_factory=set)

    def add_all(self, sections: Sequence[Chain]) -> tuple[LatencyConstraint, ...]:
        """Add all chains of the file, and give the limits of their latency."""
        by_name: dict[str, Chain] = {}
        for section in sections:
            if section.name in by_name:
                self.notes.error("APP002", f"there are two chains named {section.name!r}", section.location("name"))
            by_name.setdefault(section.name, section)
        for section in by_name.values():
            self._add(section, by_name, ())
        return tuple(
            constraint for section in by_name.values() if section.name in self.chains for constraint in _limits(section)
        )

    def _add(self, section: Chain, by_name: Mapping[str, Chain], above: tuple[str, ...]) -> perf.EventChain | None:
        """Add a chain, after those that it consists of."""
        if section.name in above:
            circle = " -> ".join((*above[above.index(section.name) :], section.name))
            place = by_name[above[-1]].location("sequence")
            self.notes.error("APP004", f"the chain {section.name!r} is part of itself: {circle}", place)
            return None
        if section.name in self._seen:
            return self.chains.get(section.name)
        self._seen.add(section.name)
        above = (*above, section.name)
        if section.path is not None:
            found = self._path(section)
        elif section.parallel is not None:
            found = self._parallel(section, section.parallel)
        else:
            found = self._sequence(section, section.sequence or [], by_name, above)
        if found is not None:
            self.chains[section.name] = found
        return found

    # Paths

    def _path(self, section: Chain) -> perf.EventChain | None:
        names = self._along(section, section.path or [], lambda index: section.location("path", index))
        if names is None:
            return None
        segments = tuple(perf.Segment(stimulus=first, response=then) for first, then in pairwise(names))
        items = perf.Sequence(segments) if len(segments) > 1 else None
        return perf.EventChain(name=section.name, stimulus=names[0], response=names[-1], items=items, origin=section.location())

    def _along(self, section: Chain, path: Sequence[str], place: Callable[[int], Location | None]) -> list[str] | None:
        """The names of the events along a path; None, with a note, if it is no path."""
        for index, name in enumerate(path):
            if name in path[:index]:
                message = f"the path goes through {name!r} twice, a chain has no circles"
                self.notes.error("APP004", message, place(index), "Make two chains of it, and a third one of their sequence.")
                return None
        unknown = [index for index, name in enumerate(path) if name not in self.members and name not in self.labels]
        for index in unknown:
            self.notes.unknown("process, function or label", path[index], {*self.members, *self.labels}, place(index))
        if unknown:
            return None
        for index in (0, len(path) - 1):
            if path[index] not in self.members:
                message = f"a chain starts and ends with a process or function, {path[index]!r} is a label"
                self.notes.error("APP004", message, place(index))
                return None
        self._check_hops(path, place)
        names = [self._moment(path[0], section.start)]
        for before, name, behind in zip(path, path[1:], path[2:], strict=False):
            if name in self.labels and name not in self.members:
                names.append(self._write(before, name))
            elif behind in self.members:
                # A member that writes a label of the path does so before it ends: the write stands for it.
                names.append(self._moment(name, "finish"))
        names.append(self._moment(path[-1], section.end))
        if names[0] == names[-1]:
            message = f"the chain {section.name!r} starts with the event with which it ends"
            self.notes.error("APP004", message, section.location(), "Let it end later, or start earlier: see 'from' and 'to'.")
            return None
        return names

    def _check_hops(self, path: Sequence[str], place: Callable[[int], Location | None]) -> None:
        """Note where nothing carries the effect from one member to the next."""
        members = [(index, name) for index, name in enumerate(path) if name in self.members]
        for (start, first), (end, then) in pairwise(members):
            between = path[start + 1 : end]
            for label in between:
                if label not in self.members[first].writes:
                    self.notes.warning("UR130", f"{first!r} does not write {label!r}", place(start + 1))
                if label not in self.members[then].reads:
                    self.notes.warning("UR130", f"{then!r} does not read {label!r}", place(end))
            if not between and carrier(self.members[first], self.members[then]) is None:
                message = f"nothing carries the effect from {first!r} to {then!r}"
                advice = f"Let {first!r} write a label that {then!r} reads, or trigger it."
                self.notes.warning("UR130", message, place(end), advice)

    def _moment(self, name: str, moment: Moment) -> str:
        """The event of a member that stands for a moment."""
        member = self.members[name]
        title = f"{name}_{moment}"
        if member.runnable is None:
            event: perf.Event = perf.ProcessEvent(name=title, process=member.process, change=_PROCESS_CHANGES[moment])
        else:
            # A function is activated with its process and starts when it is called.
            change = perf.RunnableChange.TERMINATE if moment == "finish" else perf.RunnableChange.START
            event = perf.RunnableEvent(name=title, runnable=member.runnable, change=change, process=member.process)
        self.events.setdefault(title, event)
        return title

    def _write(self, writer: str, label: str) -> str:
        """The event of a label that is written."""
        title = f"{label}_written_by_{writer}"
        process = self.members[writer].process if writer in self.members else None
        self.events.setdefault(title, perf.LabelEvent(name=title, label=label, change=perf.LabelChange.WRITE, process=process))
        return title

    # Chains of chains

    def _sequence(
        self, section: Chain, names: Sequence[str], by_name: Mapping[str, Chain], above: tuple[str, ...]
    ) -> perf.EventChain | None:
        parts: list[perf.EventChain] = []
        for index, name in enumerate(names):
            if name not in by_name:
                self.notes.unknown("chain", name, by_name, section.location("sequence", index))
                continue
            part = self._add(by_name[name], by_name, above)
            if part is not None:
                parts.append(part)
        if len(parts) < len(names):
            return None
        for index, (before, after) in enumerate(pairwise(parts), start=1):
            if before.response != after.stimulus:
                message = f"{after.name!r} starts with {after.stimulus!r}, but {before.name!r} ends with {before.response!r}"
                advice = "Let one start with what the other ends with: see 'from' and 'to'."
                self.notes.error("APP004", message, section.location("sequence", index), advice)
                return None
        items = perf.Sequence(tuple(perf.ChainReference(chain=part.name) for part in parts))
        return perf.EventChain(
            name=section.name, stimulus=parts[0].stimulus, response=parts[-1].response, items=items, origin=section.location()
        )

    def _parallel(self, section: Chain, paths: Sequence[Sequence[str]]) -> perf.EventChain | None:
        place = section.location("parallel")
        found = [names for path in paths if (names := self._along(section, path, lambda _: place)) is not None]
        if len(found) < len(paths):
            return None
        ends = {(names[0], names[-1]) for names in found}
        if len(ends) > 1 or any(len(names) < 3 for names in found):
            message = "parallel paths start with the same member, end with the same one, and have others in between"
            self.notes.error("APP004", message, place)
            return None
        if section.completed > len(paths):
            message = f"{section.completed} of {len(paths)} paths cannot complete"
            self.notes.error("APP004", message, section.location("completed"))
        branches = tuple(
            perf.Segment(
                stimulus=names[0],
                response=names[-1],
                items=perf.Sequence(tuple(perf.Segment(stimulus=first, response=then) for first, then in pairwise(names))),
            )
            for names in found
        )
        items = perf.Parallel(items=branches, completed=section.completed)
        ((first, last),) = ends
        return perf.EventChain(name=section.name, stimulus=first, response=last, items=items, origin=section.location())


def carrier(first: Member, then: Member) -> str | None:
    """What carries the effect from one member to the next: a label, a trigger, or a topic by way of the agent."""
    label = min(first.writes & then.reads, default=None)
    if label is not None:
        return label
    if then.process in first.activates:
        return f"trigger of {then.process}"
    return min(first.sends & then.receives, default=None)


def _limits(section: Chain) -> list[LatencyConstraint]:
    found = []
    for kind, limits in ((LatencyKind.REACTION, section.reaction), (LatencyKind.AGE, section.age)):
        if limits is not None:
            found.append(
                LatencyConstraint(
                    name=f"{section.name}_{kind}",
                    chain=section.name,
                    kind=kind,
                    minimum=limits.min,
                    maximum=limits.max,
                    origin=limits.location(),
                )
            )
    return found
