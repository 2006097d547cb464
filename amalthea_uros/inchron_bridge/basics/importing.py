"""The state of one run of making a system of a project."""

from __future__ import annotations

from functools import partial

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron.project import Project


class Importing:
    """Project -> system.

    Attributes
    ----------
    findings : what could not be understood
    frequencies : of the cores, by their objects; None if unknown
    """

    def __init__(self, project: Project) -> None:
        self.project = project
        self.findings: list[Finding] = []
        self._names: dict[str, dict[ProjectObject, str]] = {}
        self._taken: set[tuple[str, str]] = set()
        self._left_out: dict[str, list[ProjectObject]] = {}

    def name(self, kind: str, item: ProjectObject, wish: str | None = None) -> str:
        """Give an object a name that is unique within a kind."""
        own = found = wish or item.name or f"unnamed_{item.kind.rpartition('.')[2]}"
        number = 2
        while (kind, found) in self._taken:
            found, number = f"{own}_{number}", number + 1
        if found != own:
            self.note("INC007", f"another {kind} has the name {own!r}, too; this one is called {found!r} here", item)
        self._taken.add((kind, found))
        self._names.setdefault(kind, {})[item] = found
        return found

    def name_of(self, kind: str, item: ProjectObject) -> str | None:
        """The name that an object has been given; None if it has no counterpart."""
        return self._names.get(kind, {}).get(item)

    def location(self, item: ProjectObject) -> Location | None:
        """Where an object is in the file."""
        return self.project.location(item)

    def located(self, item: ProjectObject) -> partial[Location | None]:
        """Finds where an object is in the file."""
        return partial(self.project.location, item)

    def note(self, rule: str, message: str, item: ProjectObject, severity: Severity = Severity.WARNING) -> None:
        """Add a finding about an object."""
        self.findings.append(Finding(rule, severity, message, self.location(item), "", item.name))

    def leave_out(self, item: ProjectObject, what: str = "") -> None:
        """Report that an object, or something of it, has no counterpart; one finding for each class."""
        self._left_out.setdefault(what or item.kind, []).append(item)

    def finish(self) -> tuple[Finding, ...]:
        """All findings."""
        for what, items in self._left_out.items():
            times = f" ({len(items)} times, this is the first)" if len(items) > 1 else ""
            self.note("INC006", f"{what} of the project is not understood and left out{times}", items[0])
        return tuple(dict.fromkeys(self.findings))
