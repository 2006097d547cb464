"""Findings: what is wrong, where, and what to do."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path

from amalthea_uros._internal.records import dataclass


class Severity(StrEnum):
    """How much a finding matters."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class ToolEffect(StrEnum):
    """The effect of a tool on the object of a finding when it imports the model.

    Attributes
    ----------
    FAILS : it refuses the model or crashes
    CHANGES : it imports something else
    DROPS : it leaves the object, or a part of it, out
    KEEPS : it imports what the model says, which is probably not what is meant
    """

    FAILS = "fails"
    CHANGES = "changes"
    DROPS = "drops"
    KEEPS = "keeps"


@dataclass(frozen=True, slots=True)
class Location:
    """A place in a file.

    Attributes
    ----------
    path : the file, as it was given
    line, column : counted from 1; None where a finding concerns the whole file
    text : the line itself, for showing it
    """

    path: Path
    line: int | None = None
    column: int | None = None
    text: str | None = None

    def __str__(self) -> str:
        return ":".join(str(part) for part in (self.path, self.line, self.column) if part is not None)


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing to tell.

    Attributes
    ----------
    rule : id of the rule, e.g. "XMI020"
    message : what is wrong
    help : what to do about it, "" if there is nothing to add
    object : qualified name of the object concerned, "" if none
    effect : what the tool does that the rule is about; None if it is about none, or only about what a tool reports
    """

    rule: str
    severity: Severity
    message: str
    location: Location | None = None
    help: str = ""
    object: str = ""
    effect: ToolEffect | None = None

    @property
    def grade(self) -> str:
        """The severity, with the effect if there is one."""
        return f"{self.severity} ({self.effect})" if self.effect else self.severity

    def __str__(self) -> str:
        where = f"{self.location}: " if self.location else ""
        return f"{where}{self.rule} {self.grade}: {self.message}"


def by_place(finding: Finding) -> tuple[str, int, int, str]:
    """A key that sorts findings by file, line, column and rule."""
    place = finding.location
    return (str(place.path), place.line or 0, place.column or 0, finding.rule) if place else ("", 0, 0, finding.rule)


def worst(findings: Iterable[Finding]) -> Severity | None:
    """The highest severity among findings, None if there are none."""
    present = {finding.severity for finding in findings}
    return next((severity for severity in Severity if severity in present), None)
