"""The state of one run of making a system of a project."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, TypeVar

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron.project import Project
from amalthea_uros.inchron_bridge.basics.comments import kept_fields, kept_whole, noted, whole
from amalthea_uros.inchron_bridge.basics.seals import require_sealed
from amalthea_uros.units import Frequency

T = TypeVar("T")


class Importing:
    """Project -> system.

    Attributes
    ----------
    findings : what could not be understood
    damaged : objects of which the comment cannot be used, so that they mean more than is known
    derived_clocks : clocks of cores that a prescaler makes slower than any clock of the project
    frequency : of all cores, None if it is unknown or they differ
    """

    def __init__(self, model: ProjectObject, project: Project | None = None) -> None:
        self.model = model
        self.project = project
        self.derived_clocks: dict[str, Frequency | None] = {}
        self.frequency: Frequency | None = None
        self.findings: list[Finding] = []
        self.damaged: set[ProjectObject] = set()
        self._names: dict[str, dict[ProjectObject, str]] = {}
        self._taken: set[tuple[str, str]] = set()
        self._left_out: dict[str, list[ProjectObject]] = {}

    def name(self, kind: str, item: ProjectObject, wish: str | None = None) -> str:
        """Give an object a name that is unique within a kind."""
        own = result = wish or item.name or f"unnamed_{item.kind.rpartition('.')[2]}"
        number = 2
        while (kind, result) in self._taken:
            result, number = f"{own}_{number}", number + 1
        if result != own:
            self.note("INC007", f"another {kind} has the name {own!r}, too; this one is called {result!r} here", item)
        self._taken.add((kind, result))
        self._names.setdefault(kind, {})[item] = result
        return result

    def share(self, kind: str, item: ProjectObject, name: str) -> None:
        """Let an object have the same name within another kind."""
        self._names.setdefault(kind, {})[item] = name

    def name_of(self, kind: str, item: ProjectObject | None) -> str | None:
        """The name that an object has been given; None if it has no counterpart."""
        return None if item is None else self._names.get(kind, {}).get(item)

    def location(self, item: ProjectObject) -> Location | None:
        """Where an object is in the file."""
        return self.project.location(item) if self.project is not None else None

    def located(self, item: ProjectObject) -> partial[Location | None]:
        """Finds where an object is in the file."""
        return partial(self.location, item)

    def noted(self, item: ProjectObject) -> dict[str, Any]:
        """The content of the comment of an object; empty, with a finding, if it is damaged."""
        try:
            return noted(item)
        except UnknownError as error:
            self.comment_unused(item, error)
            self.damaged.add(item)
            return {}

    def fields(self, item: ProjectObject, kind: type[Any], names: Iterable[str]) -> dict[str, Any]:
        """The values of fields that the comment keeps; none, with a finding, if it is damaged."""
        try:
            return kept_fields(item, kind, names)
        except UnknownError as error:
            self.comment_unused(item, error)
            return {}

    def whole(self, item: ProjectObject, key: str, kinds: Iterable[type[T]], *, sealed: bool = True, **known: Any) -> T | None:
        """The object that the comment keeps under a key; None, with a finding, if it is damaged, or the project was changed."""
        try:
            result = kept_whole(item, key, kinds, **known)
            if result is not None and sealed:
                require_sealed(item)
        except UnknownError as error:
            self.comment_unused(item, error)
            return None
        return result

    def checked(
        self, item: ProjectObject, key: str, kind: type[T], flaw_of: Callable[[T], str | None], **known: Any
    ) -> T | None:
        """The object that the comment keeps under a key; None if there is none, or if it cannot be used, with a finding.

        Parameters
        ----------
        flaw_of : why an object cannot be used; None if it can
        """
        result = self.whole(item, key, (kind,), sealed=False, **known)
        flaw = None if result is None else flaw_of(result)
        if flaw is not None:
            self.comment_unused(item, UnknownError(flaw))
        if flaw is not None or (result is None and key in self.noted(item)):
            self.damaged.add(item)
            return None
        return result

    def list_of(self, item: ProjectObject, key: str, kinds: Iterable[type[T]]) -> tuple[T, ...]:
        """The objects that the comment keeps under a key; those that are damaged are left out, with a finding."""
        content = self.noted(item).get(key)
        result = []
        for each in content if isinstance(content, list) else ():
            try:
                result.append(whole(each, kinds))
            except UnknownError as error:
                self.comment_unused(item, error)
        return tuple(result)

    def comment_unused(self, item: ProjectObject, error: UnknownError) -> None:
        """Report that a comment of ours says nothing."""
        what = f"{item.kind} {item.name!r}".rstrip()
        self.note("INC008", f"what the comment of {what} keeps is not used: {error}", item)

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
