"""Event chains as sequences of events: containers and references are unfolded, alternatives and joins become forks.

Chains are not changed as by INCHRON's importer: missing inner events are skipped, and if a segment does not start with the end of the
previous one, both events are kept. Only the start of a first segment, or the end of a last one, that differs from that of the chain
is ignored and reported.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.events import ChainReference, EventChain, EventSet, Parallel, Segment
from amalthea_uros.perf.events import Sequence as InSequence
from amalthea_uros.perf.system import System

#: A chain with more routes, or with more events in all its branches, is not evaluated.
MAX_ROUTES = 256
MAX_EVENTS = 10_000


@dataclass(frozen=True, slots=True)
class Fork:
    """Parts of a chain side by side.

    Attributes
    ----------
    branches : sequences of events and further forks
    needed : how many of them have to complete
    name : of the set of events that it represents, if any
    part : name of the chain or segment that has the parts
    """

    branches: tuple[Unfolded, ...]
    needed: int
    name: str = ""
    part: str = field(default="", compare=False)


#: Names of events, and forks.
Unfolded = tuple["str | Fork", ...]


def unfold(chain: EventChain, system: System) -> tuple[Unfolded, tuple[str, ...]]:
    """The events of a chain, and those that were ignored because the chain starts or ends with others.

    Raises
    ------
    UnknownError : it is part of itself, refers to something missing, or has less than two events.
    """
    unfolding = _Unfolding(system)
    for part in _parts_first(chain, system):
        unfolding.unfolded[part.name] = unfolding.item(part)
    found = unfolding.unfolded[chain.name]
    if routes(found) > MAX_ROUTES:
        raise UnknownError(f"it has more than {MAX_ROUTES} routes")
    if any(len(events) < 2 for events in sequences(found)):
        raise UnknownError("it has no stimulus or no response, and no segment that defines one")
    return found, tuple(dict.fromkeys(unfolding.left_out))


def _parts_first(chain: EventChain, system: System) -> list[EventChain]:
    """A chain after all chains that it refers to, each once: chains that refer to the next one twice are unfolded in linear time."""
    found: dict[str, EventChain] = {}
    path: dict[str, Iterator[str]] = {chain.name: _references(chain)}
    chains = {**system.chains, chain.name: chain}
    while path:
        name, references = next(reversed(path.items()))
        reference = next((other for other in references if other not in found), None)
        if reference is None:
            path.popitem()
            found[name] = chains[name]
        elif reference in path:
            above = list(path)
            cycle = " -> ".join((*above[above.index(reference) :], reference))
            raise UnknownError(f"it contains itself: {cycle}")
        elif reference not in chains:
            raise UnknownError(f"its part {reference!r} is not defined in the model")
        else:
            path[reference] = _references(chains[reference])
    return list(found.values())


def _references(chain: EventChain) -> Iterator[str]:
    """The names of the chains that a chain and the segments within it refer to, in order."""
    pending: list[ChainReference | EventChain | Segment] = [chain]
    while pending:
        item = pending.pop()
        if isinstance(item, ChainReference):
            yield item.chain
        elif item.items is not None:
            pending.extend(reversed(item.items.items))


def routes(unfolded: Unfolded) -> int:
    """The number of ways through a chain."""
    product = 1
    for part in unfolded:
        if isinstance(part, Fork):
            product *= max(1, sum(routes(branch) for branch in part.branches))
    return product


def _size(unfolded: Unfolded) -> int:
    """The number of events, forks and branches in all branches of a chain."""
    return 1 + sum(1 if isinstance(part, str) else 1 + sum(map(_size, part.branches)) for part in unfolded)


@dataclass(frozen=True, slots=True)
class _Unfolding:
    system: System
    left_out: list[str] = field(default_factory=list)
    unfolded: dict[str, Unfolded] = field(default_factory=dict)

    def item(self, item: EventChain | Segment) -> Unfolded:
        match item.items:
            case InSequence(items=items):
                inner: Unfolded = tuple(part for each in self._parts(items) for part in each)
            case Parallel(items=items, completed=completed) if items:
                branches = tuple(self._parts(items))
                inner = (Fork(branches, min(max(completed, 1), len(branches)), part=item.name),)
            case _:
                inner = ()
        start, end = self._event(item.stimulus), self._event(item.response)
        if isinstance(item.items, InSequence):
            inner = self._between(start, inner, end)
        return _joined((*start, *inner, *end))

    def _between(self, start: Unfolded, inner: Unfolded, end: Unfolded) -> Unfolded:
        """What is inside, without other ends than the chain has."""
        first, last = inner[:1], inner[-1:]
        if start and first and isinstance(first[0], str) and first != start:
            self.left_out.append(first[0])
            inner = inner[1:]
        if end and last and isinstance(last[0], str) and last != end and inner:
            self.left_out.append(last[0])
            inner = inner[:-1]
        return inner

    def _parts(self, items: Iterable[ChainReference | Segment]) -> Iterator[Unfolded]:
        size = 0
        for item in items:
            part = self.item(item) if isinstance(item, Segment) else self.unfolded[item.chain]
            size += _size(part)
            if size > MAX_EVENTS:
                raise UnknownError(f"it has more than {MAX_EVENTS:,} events in all its branches")
            yield part

    def _event(self, name: str | None) -> Unfolded:
        if name is None:
            return ()
        event = self.system.events_by_name.get(name)
        if event is None:
            raise UnknownError(f"the event {name!r} is not defined in the model")
        if not isinstance(event, EventSet):
            return (name,)
        parts = tuple(self._event(inner) for inner in event.events)
        return (Fork(parts, len(parts), name),) if len(parts) > 1 else tuple(part for inner in parts for part in inner)


def _joined(parts: Iterable[str | Fork]) -> Unfolded:
    """The parts without consecutive duplicates; events at the ends of branches are not repeated before or after the fork."""
    found: list[str | Fork] = []
    for part in parts:
        if found and (found[-1] == part or _is_same_set(found[-1], part)):
            continue
        if isinstance(part, Fork) and found and isinstance(found[-1], str):
            part = _without(part, found[-1], at_start=True)
        if isinstance(part, str) and found and isinstance(found[-1], Fork):
            found[-1] = _without(found[-1], part, at_start=False)
        found.append(part)
    return tuple(found)


def _is_same_set(one: str | Fork, other: str | Fork) -> bool:
    """Whether both represent the set of events at the end of one part of a chain and the start of the next one."""
    return isinstance(one, Fork) and isinstance(other, Fork) and bool(one.name) and one.name == other.name


def _without(fork: Fork, event: str, at_start: bool) -> Fork:
    """A fork whose branches do not repeat the event before or after it."""

    def trimmed(branch: Unfolded) -> Unfolded:
        if at_start:
            return branch[1:] if branch[:1] == (event,) else branch
        return branch[:-1] if branch[-1:] == (event,) else branch

    return replace(fork, branches=tuple(map(trimmed, fork.branches)))


def sequences(unfolded: Unfolded) -> list[tuple[str, ...]]:
    """All ways through, each as a sequence of events."""
    found: list[tuple[str, ...]] = [()]
    for part in unfolded:
        ways = [(part,)] if isinstance(part, str) else [way for branch in part.branches for way in sequences(branch)]
        found = [(*before, *way) for before in found for way in ways]
    return found


def combined(unfolded: Unfolded, value: Mapping[tuple[str, ...], int | None], before: tuple[str, ...] = ()) -> int | None:
    """The value of a chain from those of all ways through it; None means unbounded.

    The branches of a fork are sorted by value; the value of the fork is that of the branch with which enough of them have completed.
    """
    for index, part in enumerate(unfolded):
        if isinstance(part, Fork):
            rest = unfolded[index + 1 :]
            values = [combined((*branch, *rest), value, before) for branch in part.branches]
            return sorted(values, key=lambda each: (each is None, each or 0))[part.needed - 1]
        before = (*before, part)
    return value[before]


def is_decided_by_one_path(unfolded: Unfolded, *, is_upper: bool) -> bool:
    """Whether the path with the greatest value, or for a minimum that with the least one, decides on a reaction.

    The maximum of minima is not the minimum of maxima: elsewhere what follows from the extremes of the paths is only a bound.
    """
    return all(fork.needed == (len(fork.branches) if is_upper else 1) for fork in forks(unfolded))


def forks(unfolded: Unfolded) -> Iterator[Fork]:
    """All forks of a chain."""
    for part in unfolded:
        if isinstance(part, Fork):
            yield part
            for branch in part.branches:
                yield from forks(branch)


def steps(chain: EventChain, system: System) -> Iterator[tuple[EventChain | Segment, tuple[str, ...], tuple[str, ...]]]:
    """The steps that a chain and the segments within it take themselves: from any of some events to any of others."""
    pending: list[EventChain | Segment] = [chain]
    while pending:
        item = pending.pop()
        own = item.items.items if item.items is not None else ()
        parts = [resolved for part in own if (resolved := _resolved(part, system)) is not None]
        pending.extend(part for part in reversed(own) if isinstance(part, Segment))
        if item.items is None:
            found = [(item.stimulus, item.response)]
        elif isinstance(item.items, Parallel):
            found = [(item.stimulus, part.stimulus) for part in parts]
            found += [(part.response, item.response) for part in parts]
        else:
            found = [(part.response, following.stimulus) for part, following in pairwise(parts)]
        yield from ((item, _events(first, system), _events(then, system)) for first, then in found)


def _resolved(part: ChainReference | Segment, system: System) -> EventChain | Segment | None:
    return system.chains.get(part.chain) if isinstance(part, ChainReference) else part


def _events(name: str | None, system: System) -> tuple[str, ...]:
    """The events that an end of a chain means: all of a set."""
    event = system.events_by_name.get(name or "")
    if isinstance(event, EventSet):
        return event.events
    return (event.name,) if event is not None else ()


def events_of(chain: EventChain, system: System) -> set[str]:
    """All events of a chain, of its segments and of the chains that it refers to."""
    return {event for end in _ends(chain, system) for event in _events(end, system)}


def empty_sets(chain: EventChain, system: System) -> list[str]:
    """The sets without events that a chain, its segments or the chains that it refers to start or end with; they are skipped."""
    sets = ((end, system.events_by_name.get(end)) for end in sorted(_ends(chain, system)))
    return [end for end, event in sets if isinstance(event, EventSet) and not event.events]


def _ends(chain: EventChain, system: System) -> set[str]:
    """The stimuli and responses of a chain, of its segments and of the chains that it refers to."""
    found: set[str] = set()
    seen: set[str] = set()
    pending: list[EventChain | Segment] = [chain]
    while pending:
        item = pending.pop()
        found.update(end for end in (item.stimulus, item.response) if end is not None)
        for part in item.items.items if item.items is not None else ():
            if isinstance(part, ChainReference) and part.chain in seen:
                continue
            if isinstance(part, ChainReference):
                seen.add(part.chain)
            resolved = _resolved(part, system)
            if resolved is not None:
                pending.append(resolved)
    return found
