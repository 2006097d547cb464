"""One flaw, one finding: findings of the same flaw become a group, and what follows from a finding becomes part of its group."""

from __future__ import annotations

import re
from bisect import bisect_left, insort
from collections import defaultdict
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Finding, worst
from amalthea_uros.findings.flaws import CONSEQUENCES, FLAWS, Consequence, FindingSource, Flaw

_QUOTED = re.compile(r"""['"<]([^'"<>]+)['">]""")

#: The separator between the name and the class of an object in a reference.
_TYPE = "?type="

#: Findings whose object is not the qualified name of an object of the model.
_WITHOUT_OBJECT = ("XSD001",)

#: How many kinds of findings at a place are compared with another one; more than this is no model that somebody wrote.
_SEARCHED = 50


@dataclass(frozen=True, slots=True)
class FindingGroup:
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
        return replace(first, severity=worst(self.members) or first.severity)

    @property
    def members(self) -> tuple[Finding, ...]:
        """All findings of the group."""
        return (*self.same, *self.consequences)

    @property
    def also(self) -> tuple[str, ...]:
        """The ids of the other findings of the same flaw."""
        return tuple(dict.fromkeys(finding.rule for finding in self.same[1:]))


def group(findings: Sequence[Finding]) -> list[FindingGroup]:
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


def _group(members: Iterable[_Item], effects: Iterable[_Item]) -> FindingGroup:
    same = tuple(item.finding for item in members)
    return FindingGroup(same, tuple(item.finding for item in sorted(effects, key=lambda item: item.position)))


class _Alike(NamedTuple):
    """What findings have in common that a search cannot tell apart, unless by their lines."""

    place: Hashable
    object: str
    names: frozenset[str]


#: A line, the position of a finding, and the findings that belong together with it.
_Entry = tuple[int, int, list[_Item]]


#: The part of the names that is the same, the distance in lines as a negative number, and whether the object fits exactly.
_Nearness = tuple[float, int, bool]
_NEAREST: _Nearness = (1.0, 0, True)


class _Index:
    """Finds what may belong to a finding: what is reported at the same place, about the same object or name.

    A file may have thousands of flaws at one place, e.g. all in one line; no search looks at all of them.
    """

    def __init__(self, in_file: bool, same_name: bool, of_events: bool = False) -> None:
        self.in_file = in_file
        self.same_name = same_name
        self.of_events = of_events
        self._entries: dict[_Alike, list[_Entry]] = {}
        self._found: dict[Hashable, dict[_Alike, None]] = defaultdict(dict)

    def add(self, cluster: list[_Item]) -> None:
        """Add findings that belong together, to be found by the first of them."""
        item = cluster[0]
        alike = self._alike(item)
        if alike not in self._entries:
            self._entries[alike] = []
            for key in self._keys(alike, (alike.object, None)):
                self._found[key][alike] = None
        insort(self._entries[alike], (item.line, item.position, cluster))

    def nearest(self, item: _Item) -> list[_Item] | None:
        """The findings that are the most similar ones to another one, if any may belong to it."""
        best = self._best(item)
        return self._entries[best[0]][best[1]][-1] if best else None

    def take(self, item: _Item) -> list[_Item] | None:
        """The same findings, which are not found again until they are added again."""
        best = self._best(item)
        if best is None:
            return None
        alike, index = best
        *_, cluster = self._entries[alike].pop(index)
        if not self._entries[alike]:
            del self._entries[alike]
            for key in self._keys(alike, (alike.object, None)):
                del self._found[key][alike]
        return cluster

    def _alike(self, item: _Item) -> _Alike:
        return _Alike(item.place(self.in_file), item.object, names_in(item.finding))

    def _keys(self, alike: _Alike, objects: Iterable[str | None]) -> list[Hashable]:
        """What findings are found by: their place, object (None: of any object) and each name (None: of any name)."""
        names: frozenset[str | None] = names_of_events(alike.names) if self.of_events else alike.names
        names = names if self.same_name else names | {None}
        return [(alike.place, name, about) for about in objects for name in names]

    def _best(self, item: _Item) -> tuple[_Alike, int] | None:
        """Where the findings are that are nearest to another one; of several the first ones."""
        best = max(self._near(item), key=lambda near: near[:2], default=None)
        return best[2:] if best else None

    def _near(self, item: _Item) -> Iterator[tuple[_Nearness, int, _Alike, int]]:
        """What may belong to a finding, and how near it is; no more once nothing can be nearer."""
        own = self._alike(item)
        keys = self._keys(own, (None,) if self.in_file or not item.object else (item.object, ""))
        # What few findings name says most.
        keys.sort(key=lambda key: len(self._found.get(key, ())))
        for alike in islice(chain.from_iterable(self._found.get(key, ()) for key in keys), _SEARCHED):
            common = likeness(alike.names, own.names, self.of_events)
            if self.in_file and self.same_name and common < 1:
                continue
            distance, position, index = _nearest_line(self._entries[alike], item.line)
            nearness = (common, -distance, self.in_file or alike.object == own.object)
            yield nearness, -position, alike, index
            if nearness == _NEAREST:
                return


def _nearest_line(entries: Sequence[_Entry], line: int) -> tuple[int, int, int]:
    """Distance, position and index of the entry that is nearest to a line, of several the first one."""
    after = bisect_left(entries, (line,))
    before = bisect_left(entries, entries[after - 1][:1]) if after else 0
    return min((abs(entries[i][0] - line), entries[i][1], i) for i in {before, after} if i < len(entries))


def _clusters(flaw: Flaw, by_id: _ById) -> list[list[_Item]]:
    """Findings that report the same flaw; each source reports it once."""
    if sum(source.id in by_id for source in flaw.sources) < 2:
        return []
    index = _Index(flaw.in_file, flaw.same_name, flaw.of_events)
    clusters: list[list[_Item]] = []
    for source in flaw.sources:
        reported = [_with(index.take(item), item) for item in _of(source, by_id)]
        for cluster in reported:
            index.add(cluster)
        clusters += (cluster for cluster in reported if len(cluster) == 1)
    return clusters


def _with(cluster: list[_Item] | None, item: _Item) -> list[_Item]:
    """The findings of a flaw with another one."""
    if cluster is None:
        return [item]
    cluster.append(item)
    return cluster


def _of(source: FindingSource, by_id: _ById) -> Iterator[_Item]:
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
            near = None if is_explained else index.nearest(item)
            if near is not None:
                yield item, near[0]


def _root(causes: Mapping[int, int], flaw: int) -> int:
    """The flaw that is the cause of the cause, and so on."""
    while flaw in causes:
        flaw = causes[flaw]
    return flaw


# What messages name, to see whether two findings are about the same thing.


def names_in(finding: Finding) -> frozenset[str]:
    """What a message names in quotes; where it quotes references, only the objects to which these refer."""
    quoted = _QUOTED.findall(finding.message)
    references = [name.partition(_TYPE)[0] for name in quoted if _TYPE in name]
    return frozenset(references or quoted)


def names_of_events(names: frozenset[str]) -> frozenset[str]:
    """Names, and what comes before their last underscore: an event `Sense_start` is one of the function `Sense`."""
    return names | {name.rpartition("_")[0] for name in names if "_" in name.strip("_")}


def likeness(one: frozenset[str], other: frozenset[str], of_events: bool = False) -> float:
    """Which part of the names of two findings is the same, 1 if all names of one of them are.

    Parameters
    ----------
    of_events : a function is the same as one of its events
    """
    if not one or not other:
        return 0.0
    more = names_of_events if of_events else frozenset[str]
    return max(len(one & more(other)) / len(one), len(other & more(one)) / len(other))
