"""Problems in a file that can nevertheless be read; equal ones are reported once, with the number of occurrences."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path

from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.metamodel.source import SourceText


class CollectedFinding:
    """A finding about the tag at an offset (in bytes of UTF-8) or one of its attributes, with the number of its occurrences."""

    __slots__ = ("attribute", "count", "help", "message", "offset", "rule", "severity")

    def __init__(self, rule: str, severity: Severity, message: str, help_text: str, offset: int, attribute: str = "") -> None:
        self.rule = rule
        self.severity = severity
        self.message = message
        self.help = help_text
        self.offset = offset
        self.attribute = attribute
        self.count = 1

    def finding(self, path: Path, source: SourceText) -> Finding:
        """The finding, at the first occurrence."""
        where = location(path, source, self.offset, self.attribute)
        times = f" ({self.count} times, this is the first)" if self.count > 1 else ""
        return Finding(self.rule, self.severity, self.message + times, where, self.help)


class FindingCollector:
    """The problems of one file."""

    def __init__(self) -> None:
        self._findings: dict[tuple[str, str], CollectedFinding] = {}
        self._suggestions = Suggestions()

    def add(self, finding: CollectedFinding, name: str = "", known_names: Collection[str] = ()) -> None:
        """Add a problem; if it is about an unknown name, the most similar known one is suggested."""
        known = self._findings.get((finding.rule, finding.message))
        if known is not None:
            known.count += 1
            return
        if name:
            finding.help = self._suggestions.advice(name, known_names) + finding.help
        self._findings[finding.rule, finding.message] = finding

    def __iter__(self) -> Iterator[CollectedFinding]:
        return iter(self._findings.values())


def location(path: Path, source: SourceText, byte_offset: int, attribute: str = "") -> Location:
    """The location of a tag, given by its offset in bytes of UTF-8, or of one of its attributes."""
    offset = source.character_offset(byte_offset)
    line, column = source.position(source.attribute_offset(offset, attribute) if attribute else offset)
    return Location(path, line, column, source.line(line))
