"""What a migration did, thing by thing, and what it brings back later."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Location
from amalthea_uros.xmi.tree.node import Node


class NoteKind(StrEnum):
    """What happened to something."""

    RENAMED = "renamed"
    MOVED = "moved"
    CONVERTED = "converted"
    DEFAULTED = "defaulted"
    KEPT = "kept as custom property"
    LOST = "lost"
    TO_CHECK = "to be checked"


class Note(NamedTuple):
    """One thing that happened to one object.

    Attributes
    ----------
    version : that to which the step leads
    message : what happened; the same text for all objects to which the same happened
    origin : the element of the file
    detail : what is particular to this object, such as a value
    attribute : the attribute of the element that it is about, "" if it is about the element
    """

    kind: NoteKind
    version: str
    message: str
    origin: int
    detail: str = ""
    attribute: str = ""


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


class StepNotes:
    """What the steps write down."""

    def __init__(self) -> None:
        self.all: list[Note] = []
        self.version = ""

    def add(self, kind: NoteKind, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """Note what happened to a node."""
        self.all.append(Note(kind, self.version, message, node.origin, detail, attribute))

    def renamed(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The same thing has another name."""
        self.add(NoteKind.RENAMED, node, message, detail, attribute)

    def moved(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The same thing is elsewhere."""
        self.add(NoteKind.MOVED, node, message, detail, attribute)

    def converted(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The same meaning is expressed by something else."""
        self.add(NoteKind.CONVERTED, node, message, detail, attribute)

    def defaulted(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """A value that was not in the file is written now."""
        self.add(NoteKind.DEFAULTED, node, message, detail, attribute)

    def kept(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The newer version has no place for it; it is a custom property now."""
        self.add(NoteKind.KEPT, node, message, detail, attribute)

    def lost(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """It is not in the result."""
        self.add(NoteKind.LOST, node, message, detail, attribute)

    def to_check(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """It is unchanged, but the newer version does not allow it, or reads it in another way."""
        self.add(NoteKind.TO_CHECK, node, message, detail, attribute)


# What the published conversions lose at a step, and which is brought back as soon as the content goes beyond them

#: The first version after those of which the content of ITEA versions was published as converted.
BEYOND_ITEA = "0.7.1"

#: The first version after those that the converters of APP4MC are published for.
BEYOND_CONVERTERS = "0.9.6"


@dataclass(frozen=True)
class Postponed:
    """Something that is not in the result up to a version, so that results up to there are comparable with the published ones.

    Attributes
    ----------
    until : the version from which on it is there
    restore : puts it where it belongs then
    kind, node, message, detail, attribute : what is noted of it; if the migration ends before, it is lost
    is_kept : whether it is also kept in another form, so that nothing is lost if the migration ends before
    """

    until: str
    restore: Callable[[], object]
    kind: NoteKind
    node: Node
    message: str
    detail: str = ""
    attribute: str = ""
    is_kept: bool = False


def restore_postponed(postponed: list[Postponed], version: str, notes: StepNotes) -> None:
    """Restore what was postponed until a version."""
    for one in postponed:
        if one.until == version:
            one.restore()
            notes.add(one.kind, one.node, one.message, one.detail, one.attribute)
    postponed[:] = [one for one in postponed if one.until != version]


def report_postponed(postponed: list[Postponed], notes: StepNotes) -> None:
    """Note what is not restored, because the migration ends before."""
    for one in postponed:
        if not one.is_kept:
            notes.lost(one.node, one.message, one.detail, one.attribute)
    postponed.clear()
