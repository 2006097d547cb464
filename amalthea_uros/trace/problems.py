"""Problems in a trace; equal ones are reported once, with the number of occurrences: traces have millions of lines."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from amalthea_uros.diagnostics import Finding, Location, Severity


@dataclass(frozen=True, slots=True)
class TracePlace:
    """Where in a trace a problem is.

    Attributes
    ----------
    line, column : counted from 1
    text : of the line
    """

    line: int | None = None
    column: int | None = None
    text: str | None = None


class UnreadableError(Exception):
    """A part of a trace cannot be read; the text says why.

    Attributes
    ----------
    line : of the file, counted from 1; None if it is not known
    is_cut : whether the data end early
    """

    def __init__(self, message: str, line: int | None = None, *, is_cut: bool = False) -> None:
        super().__init__(message)
        self.line, self.is_cut = line, is_cut


class TraceProblems:
    """The problems of one trace, in the order in which they occur first."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._found: dict[tuple[str, str], tuple[Finding, int]] = {}

    def add(self, rule: str, severity: Severity, message: str, place: TracePlace = TracePlace(), advice: str = "") -> None:
        """Add a problem, or an occurrence of one; the message says nothing that differs between occurrences."""
        finding, count = self._found.get((rule, message), (None, 0))
        if finding is None:
            location = None if self._path is None else Location(self._path, place.line, place.column, place.text)
            finding = Finding(rule, severity, message, location, advice)
        self._found[rule, message] = finding, count + 1

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""
        return tuple(
            replace(finding, message=f"{finding.message} ({count} times, this is the first)") if count > 1 else finding
            for finding, count in self._found.values()
        )
