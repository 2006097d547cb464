"""Collects the findings of one run."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError

_LONGEST_LIST = 12


class Notes:
    """Collects findings.

    The same mistake can be found on several paths; it is reported once.

    Attributes
    ----------
    findings : in the order in which they were found
    """

    def __init__(self) -> None:
        self.findings: list[Finding] = []
        self._known: set[Finding] = set()
        self._suggestions = Suggestions()

    def add_all(self, findings: Iterable[Finding]) -> None:
        """Add findings that are not known yet."""
        for finding in findings:
            if finding not in self._known:
                self._known.add(finding)
                self.findings.append(finding)

    def refusal(self) -> ReadError:
        """The error that carries all findings."""
        return ReadError(self.findings)

    def error(self, rule: str, message: str, location: Location | None, help_text: str = "") -> None:
        """Add a finding that prevents a model."""
        self.add_all([Finding(rule, Severity.ERROR, message, location, help_text)])

    def warning(self, rule: str, message: str, location: Location | None, help_text: str = "") -> None:
        """Add a finding that is probably a mistake."""
        self.add_all([Finding(rule, Severity.WARNING, message, location, help_text)])

    def info(self, rule: str, message: str, location: Location | None, help_text: str = "") -> None:
        """Add a finding that needs no action."""
        self.add_all([Finding(rule, Severity.INFO, message, location, help_text)])

    def undefined(self, kind: str, name: str, defined: Iterable[str], location: Location | None, *, owner: str = "") -> None:
        """Add an error about a name that is not defined.

        Parameters
        ----------
        defined : the names that are, for a suggestion
        owner : what the name would have to be defined in, e.g. "node 'n'"; "" for the file
        """
        scope = f" in {owner}" if owner else ""
        self.error("APP001", f"undefined {kind} {name!r}{scope}", location, self.suggestion(kind, name, defined))

    def suggestion(self, kind: str, name: str, defined: Iterable[str]) -> str:
        """The advice about a name that is not defined."""
        if self._suggestions.comparisons <= 0:
            return "Define it, or correct the name."
        known = sorted(set(defined))
        if not known:
            return f"Define it: there is no {kind} yet."
        near = self._suggestions.nearest(name, known)
        if near:
            return f"Did you mean {near!r}?"
        more = f" and {len(known) - _LONGEST_LIST} more" if len(known) > _LONGEST_LIST else ""
        return f"Use one of: {', '.join(known[:_LONGEST_LIST])}{more}."

    def duplicate(self, kind: str, name: str, location: Location | None, first: Location | None) -> None:
        """Add an error about a name that is defined twice.

        Parameters
        ----------
        first : the first definition
        """
        message = f"duplicate {kind} name {name!r}{first_defined(first)}"
        self.error("APP002", message, location, "Rename one of them.")

    def unique(self, kind: str, names: Iterable[tuple[str, Location | None]]) -> None:
        """Add an error for each name that two things have, in the order of the file.

        Parameters
        ----------
        names : with the places of their definitions
        """
        first: dict[str, Location | None] = {}
        for name, location in sorted(names, key=lambda item: _line(item[1])):
            if name in first:
                self.duplicate(kind, name, location, first[name])
            first.setdefault(name, location)

    @property
    def has_errors(self) -> bool:
        """Whether a finding prevents a model."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)


def _line(location: Location | None) -> tuple[int, int]:
    return (location.line or 0, location.column or 0) if location else (0, 0)


def first_defined(first: Location | None) -> str:
    """A reference to the first definition, to be appended to a message."""
    return f" (first defined on line {first.line})" if first and first.line else ""
