"""One flaw, one finding: findings of the same flaw become a group, and what follows from a finding becomes part of its group."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from amalthea_uros.diagnostics import Finding, worst
from amalthea_uros.findings.flaws import CONSEQUENCES, FLAWS, Consequence, Flaw, Source
from amalthea_uros.findings.naming import likeness, names_in, names_of_events

#: Findings whose object is not the qualified name of an object of the model.
_WITHOUT_OBJECT = ("XSD001",)


@dataclass(frozen=True, slots=True)
class Group:
    """What is shown as one finding.

    Attributes
    ----------
    same : the findings of the flaw, the one whose message says most first
    consequences : findings that disappear together with these
    """

    same: tuple[Finding, ...]
    consequences: tuple[Finding, ...] = ()

    @property
    def shown(self) -> Finding:
        """The finding that says most, with the highest severity of the group."""
        first = self.same[0]
        return replace(first, severity=worst((*self.same, *self.consequences)) or first.severity)

    @property
    def also(self) -> tuple[str, ...]:
        """The ids of the other findings of the same flaw."""
        return tuple(dict.fromkeys(finding.rule for finding in self.same[1:]))


def group(findings: Sequence[Finding]) -> list[Group]:
    """The findings by flaw, in the order of the first one of each; none is lost."""
    items = [_Item(index, finding) for index, finding in enumerate(findings)]
    by_id: _ById = defaultdict(list)
    for item in items:
        by_id[item.finding.rule].append(item)
    flaws = _Flaws(items)
    for flaw in FLAWS:
        for cluster in _clusters(flaw, by_id):
            flaws.join(cluster)
    causes = _causes(flaws, by_id)
    effects: dict[int, list[_Item]] = defaultdict(list)
    for index in causes:
        effects[_root(causes, index)] += flaws.members[index]
    return [_group(flaws.members[index], effects[index]) for index in sorted(flaws.members) if index not in causes]


class _Item(NamedTuple):
    """A finding and its position among all of them."""

    position: int
    finding: Finding

    @property
    def object(self) -> str:
        """The object of the finding, "" if it is not known."""
        return "" if self.finding.rule in _WITHOUT_OBJECT else self.finding.object

    @property
    def file(self) -> Path | None:
        """The file of the finding."""
        return self.finding.location.path if self.finding.location is not None else None

    @property
    def line(self) -> int:
        """The line of the finding, 0 if it is about the whole file."""
        return (self.finding.location.line or 0) if self.finding.location is not None else 0

    def place(self, in_file: bool) -> Hashable:
        """The file, and the line unless another line of the file will do."""
        return self.file if in_file else (self.file, self.line)


_ById = dict[str, list[_Item]]


class _Flaws:
    """Findings by flaw; a flaw is known by the position of its first finding, and the finding that says most is its first member."""

    def __init__(self, items: Iterable[_Item]) -> None:
        self.members = {item.position: [item] for item in items}
        self._flaw_of = {index: index for index in self.members}

    def flaw_of(self, item: _Item) -> int:
        """The flaw of a finding."""
        return self._flaw_of[item.position]

    def join(self, items: Sequence[_Item]) -> None:
        """Findings, the one that says most first, report the same flaw."""
        flaws = list(dict.fromkeys(map(self.flaw_of, items)))
        joined = [member for flaw in flaws for member in self.members.pop(flaw)]
        first = min(item.position for item in joined)
        for member in joined:
            self._flaw_of[member.position] = first
        self.members[first] = joined


def _group(members: Iterable[_Item], effects: Iterable[_Item]) -> Group:
    same = tuple(item.finding for item in members)
    return Group(same, tuple(item.finding for item in sorted(effects, key=lambda item: item.position)))


class _Index:
    """Finds what may belong to a finding: what is reported at the same place, about the same object or name."""

    def __init__(self, in_file: bool, same_name: bool, of_events: bool = False) -> None:
        self.in_file = in_file
        self.same_name = same_name
        self.of_events = of_events
        self._found: dict[Hashable, list[list[_Item]]] = defaultdict(list)

    def add(self, cluster: list[_Item]) -> None:
        """Add findings that belong together, to be found by the first of them."""
        item = cluster[0]
        keys = self._names(item) if self.same_name else (item.object, None)
        for key in keys:
            self._found[item.place(self.in_file), key].append(cluster)

    def near(self, item: _Item) -> list[list[_Item]]:
        """The findings that may belong to another one, the most similar ones first."""
        place = item.place(self.in_file)
        keys: Iterable[Hashable] = (None,) if self.in_file or not item.object else (item.object, "")
        if self.same_name:
            keys = self._names(item)
        found = {id(cluster): cluster for key in keys for cluster in self._found.get((place, key), ())}
        fitting = (cluster for cluster in found.values() if self._fits(cluster[0], item))
        return sorted(fitting, key=lambda cluster: self._closeness(cluster[0], item), reverse=True)

    def _names(self, item: _Item) -> frozenset[str]:
        names = names_in(item.finding)
        return names_of_events(names) if self.of_events else names

    def _fits(self, one: _Item, other: _Item) -> bool:
        if self.in_file:
            return not self.same_name or self._likeness(one, other) == 1
        return "" in (one.object, other.object) or one.object == other.object

    def _closeness(self, one: _Item, other: _Item) -> tuple[float, int]:
        """How much two findings have in common: names, then lines."""
        return self._likeness(one, other), -abs(one.line - other.line)

    def _likeness(self, one: _Item, other: _Item) -> float:
        return likeness(names_in(one.finding), names_in(other.finding), self.of_events)


def _clusters(flaw: Flaw, by_id: _ById) -> list[list[_Item]]:
    """Findings that report the same flaw; each source reports it once."""
    if sum(source.id in by_id for source in flaw.sources) < 2:
        return []
    index = _Index(flaw.in_file, flaw.same_name, flaw.of_events)
    clusters: list[list[_Item]] = []
    for source in flaw.sources:
        fresh = []
        for item in _of(source, by_id):
            cluster = next((near for near in index.near(item) if near[-1].finding.rule != source.id), None)
            if cluster is not None:
                cluster.append(item)
            else:
                fresh.append([item])
        for cluster in fresh:
            index.add(cluster)
        clusters += fresh
    return clusters


def _of(source: Source, by_id: _ById) -> Iterator[_Item]:
    """The findings that a source means."""
    return (item for item in by_id.get(source.id, ()) if source.has(item.finding))


def _causes(flaws: _Flaws, by_id: _ById) -> dict[int, int]:
    """The flaws of which every finding is a consequence, with the flaw that is the cause."""
    cause_of: dict[int, int] = {}
    for consequence in CONSEQUENCES:
        for item, cause in _caused(consequence, by_id):
            cause_of.setdefault(item.position, flaws.flaw_of(cause))
    return {
        index: cause_of[members[0].position]
        for index, members in flaws.members.items()
        if all(cause_of.get(member.position, index) != index for member in members)
    }


def _caused(consequence: Consequence, by_id: _ById) -> Iterator[tuple[_Item, _Item]]:
    """Findings, each with the finding that is its cause."""
    index = _Index(consequence.in_file, consequence.same_name)
    for cause in _of(consequence.cause, by_id):
        index.add([cause])
    others = by_id.get(consequence.except_named_by, ())
    explained = {(item.file, name) for item in others for name in names_in(item.finding)}
    for source in consequence.effects:
        for item in _of(source, by_id):
            is_explained = not explained.isdisjoint((item.file, name) for name in names_in(item.finding))
            near = [] if is_explained else index.near(item)
            if near:
                yield item, near[0][0]


def _root(causes: Mapping[int, int], flaw: int) -> int:
    """The flaw that is the cause of the cause, and so on."""
    while flaw in causes:
        flaw = causes[flaw]
    return flaw
