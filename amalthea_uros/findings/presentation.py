"""What is shown of the findings of a run: groups, and one line about each target tool that nobody asked for."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Severity, by_place
from amalthea_uros.findings.accepted import fingerprint
from amalthea_uros.findings.grouping import FindingGroup, group
from amalthea_uros.findings.targets import TargetTool, split


class FindingEntry(NamedTuple):
    """A finding for programs.

    Attributes
    ----------
    part_of : fingerprint of the finding under which it is shown, None for those that are shown themselves
    counts : whether the exit code depends on it; not so for target tools that nobody asked for
    """

    finding: Finding
    part_of: str | None
    counts: bool


@dataclass(frozen=True, slots=True)
class Presentation:
    """The findings of a run as they are shown.

    Attributes
    ----------
    groups : by flaw
    targets : the same for each target tool that nobody asked for
    """

    groups: Sequence[FindingGroup]
    targets: Mapping[TargetTool, Sequence[FindingGroup]]

    @property
    def shown(self) -> list[Finding]:
        """One finding for each flaw; the exit code depends on these."""
        return [found.shown for found in self.groups]

    def entries(self, *, details: bool = True) -> list[FindingEntry]:
        """The findings by place: all of them, or without details only those that are shown themselves."""
        entries = self._entries() if details else (FindingEntry(finding, None, counts=True) for finding in self.shown)
        return sorted(entries, key=lambda entry: by_place(entry.finding))

    def accepted(self, fingerprints: Collection[str]) -> set[Finding]:
        """The findings of which the flaw is accepted: whatever reports it or follows from it, unless it is more severe."""
        return {
            finding
            for groups in (self.groups, *self.targets.values())
            for found in groups
            if fingerprint(found.same[0]) in fingerprints
            for finding in found.members
            if not is_more_severe(finding, found.same[0])
        }

    @property
    def to_accept(self) -> list[Finding]:
        """What a baseline has to have so that no finding that counts is shown."""
        return [
            finding
            for found in self.groups
            for finding in found.members
            if finding is found.same[0] or is_more_severe(finding, found.same[0])
        ]

    def _entries(self) -> Iterator[FindingEntry]:
        for counts, groups in ((True, self.groups), *((False, groups) for groups in self.targets.values())):
            for found in groups:
                first, *others = found.members
                yield FindingEntry(first, None, counts)
                yield from (FindingEntry(finding, fingerprint(first), counts) for finding in others)


def is_more_severe(finding: Finding, other: Finding) -> bool:
    """Whether a finding is more severe than another one."""
    order = tuple(Severity)
    return order.index(finding.severity) < order.index(other.severity)


def present(findings: Sequence[Finding], asked: Collection[str] = ()) -> Presentation:
    """The findings of a run as they are shown.

    Parameters
    ----------
    asked : names of the target tools whose findings count
    """
    counting, targets = split(findings, asked)
    return Presentation(group(counting), {target: group(found) for target, found in targets.items()})
