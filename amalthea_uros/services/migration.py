"""What a migration did: to files and to objects."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from amalthea_uros.diagnostics import Location
from amalthea_uros.xmi.migrate.notes import NoteKind as NoteKind


class FileState(StrEnum):
    """What became of a file."""

    MIGRATED = "migrated"
    WRITTEN = "written"
    PLANNED = "would be written"
    AS_IS = "has this version already"
    FAILED = "not written"


@dataclass(frozen=True, slots=True, kw_only=True)
class MigratedFile:
    """A file of a model that is migrated.

    Attributes
    ----------
    version : the one before, "" if unknown
    target : the file in the new version, None if there is none
    """

    path: Path
    version: str
    target: Path | None
    state: FileState


@dataclass(frozen=True, slots=True, kw_only=True)
class MigrationChange:
    """One thing that a migration did to one object.

    Attributes
    ----------
    step : the version to which the step leads that did it, "" for reading
    message : what happened; the same for all objects to which the same happened
    detail : what is particular to this object, such as a value
    location : in the old file
    """

    kind: NoteKind
    step: str
    message: str
    detail: str
    object: str
    location: Location | None
