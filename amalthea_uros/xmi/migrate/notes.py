"""What a migration did, thing by thing."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from amalthea_uros.xmi.migrate.node import Node


class Kind(StrEnum):
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

    kind: Kind
    version: str
    message: str
    origin: int
    detail: str = ""
    attribute: str = ""


class Notes:
    """What the steps write down."""

    def __init__(self) -> None:
        self.all: list[Note] = []
        self.version = ""

    def add(self, kind: Kind, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """Note what happened to a node."""
        self.all.append(Note(kind, self.version, message, node.origin, detail, attribute))

    def renamed(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The same thing has another name."""
        self.add(Kind.RENAMED, node, message, detail, attribute)

    def moved(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The same thing is elsewhere."""
        self.add(Kind.MOVED, node, message, detail, attribute)

    def converted(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The same meaning is expressed by something else."""
        self.add(Kind.CONVERTED, node, message, detail, attribute)

    def defaulted(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """A value that was not in the file is written now."""
        self.add(Kind.DEFAULTED, node, message, detail, attribute)

    def kept(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """The newer version has no place for it; it is a custom property now."""
        self.add(Kind.KEPT, node, message, detail, attribute)

    def lost(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """It is not in the result."""
        self.add(Kind.LOST, node, message, detail, attribute)

    def to_check(self, node: Node, message: str, detail: str = "", attribute: str = "") -> None:
        """It is unchanged, but the newer version does not allow it, or reads it in another way."""
        self.add(Kind.TO_CHECK, node, message, detail, attribute)
