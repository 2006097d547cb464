"""What is odd in a file that can nevertheless be read: each kind of oddity is reported once, with the number of its occurrences."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from pathlib import Path

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.metamodel.source import Source


class CollectedFinding:
    """A finding in the making, about the tag at an offset (in bytes of UTF-8) or one of its attributes."""

    __slots__ = ("attribute", "count", "help", "message", "offset", "rule", "severity")

    def __init__(self, rule: str, severity: Severity, message: str, help_text: str, offset: int, attribute: str = "") -> None:
        self.rule = rule
        self.severity = severity
        self.message = message
        self.help = help_text
        self.offset = offset
        self.attribute = attribute
        self.count = 1

    def finding(self, path: Path, source: Source) -> Finding:
        """The finding, at the first occurrence."""
        where = location(path, source, self.offset, self.attribute)
        times = f" ({self.count} times, the first one is here)" if self.count > 1 else ""
        return Finding(self.rule, self.severity, self.message + times, where, self.help)


class FindingCollector:
    """The oddities of one file."""

    def __init__(self) -> None:
        self._findings: dict[tuple[str, str], CollectedFinding] = {}

    def add(self, remark: CollectedFinding, name: str = "", known_names: Iterable[str] = ()) -> None:
        """Note an oddity; if it is about an unknown name, a known one that is near is suggested."""
        known = self._findings.get((remark.rule, remark.message))
        if known is not None:
            known.count += 1
            return
        if name:
            remark.help = did_you_mean(name, known_names) + remark.help
        self._findings[remark.rule, remark.message] = remark

    def __iter__(self) -> Iterator[CollectedFinding]:
        return iter(self._findings.values())


def location(path: Path, source: Source, byte_offset: int, attribute: str = "") -> Location:
    """A tag, given by its offset in bytes of UTF-8, or one of its attributes, as a place to show."""
    offset = source.character_offset(byte_offset)
    line, column = source.position(source.attribute_offset(offset, attribute) if attribute else offset)
    return Location(path, line, column, source.line(line))


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """A hint, "" if nothing is near."""
    near = get_close_matches(name, list(known), n=1)
    return f"Did you mean {near[0]!r}? " if near else ""
