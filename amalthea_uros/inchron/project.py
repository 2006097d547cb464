"""A project that was read from a file."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Location
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.metamodel.source import SourceText


@dataclass(frozen=True, slots=True, kw_only=True)
class Project:
    """A project.

    Attributes
    ----------
    model : its root
    findings : what was not understood while it was read
    """

    path: Path
    model: ProjectObject
    source: SourceText = field(repr=False)
    findings: tuple[Finding, ...] = ()

    def location(self, item: ProjectObject) -> Location | None:
        """Where an object begins in the file."""
        offset = self.source.character_offset(item.offset)
        line, column = self.source.position(offset)
        return Location(self.path, line, column, self.source.line(line))
