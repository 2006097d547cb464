"""The findings of one run, as they come up."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from amalthea_uros.diagnostics import Finding, Location, Severity


class Notes:
    """Collects findings.

    The same mistake may be met on several ways; it is told once.

    Attributes
    ----------
    findings : in the order in which they came up
    """

    def __init__(self) -> None:
        self.findings: list[Finding] = []
        self._known: set[Finding] = set()

    def _add(self, finding: Finding) -> None:
        if finding not in self._known:
            self._known.add(finding)
            self.findings.append(finding)

    def error(self, rule: str, message: str, location: Location | None, help_text: str = "") -> None:
        """Something that makes a model impossible."""
        self._add(Finding(rule, Severity.ERROR, message, location, help_text))

    def warning(self, rule: str, message: str, location: Location | None, help_text: str = "") -> None:
        """Something that the author has to think about."""
        self._add(Finding(rule, Severity.WARNING, message, location, help_text))

    def info(self, rule: str, message: str, location: Location | None, help_text: str = "") -> None:
        """Something worth knowing."""
        self._add(Finding(rule, Severity.INFO, message, location, help_text))

    def unknown(self, kind: str, name: str, known: Iterable[str], location: Location | None) -> None:
        """A name that nothing has."""
        names = sorted(set(known))
        near = get_close_matches(name, names, n=1)
        some = f"There are: {', '.join(names[:12])}{', ...' if len(names) > 12 else ''}." if names else f"There is no {kind}."
        self.error("APP001", f"there is no {kind} named {name!r}", location, f"Did you mean {near[0]!r}?" if near else some)

    @property
    def has_errors(self) -> bool:
        """Whether a model is impossible."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)
