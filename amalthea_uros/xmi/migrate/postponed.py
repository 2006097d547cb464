"""What the published conversions lose at a step, and which is brought back as soon as the content goes beyond them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Kind, Notes


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
    kind: Kind
    node: Node
    message: str
    detail: str = ""
    attribute: str = ""
    is_kept: bool = False


def bring_back(postponed: list[Postponed], version: str, notes: Notes) -> None:
    """Restore what was postponed until a version."""
    for one in postponed:
        if one.until == version:
            one.restore()
            notes.add(one.kind, one.node, one.message, one.detail, one.attribute)
    postponed[:] = [one for one in postponed if one.until != version]


def give_up(postponed: list[Postponed], notes: Notes) -> None:
    """Note what is not restored, because the migration ends before."""
    for one in postponed:
        if not one.is_kept:
            notes.lost(one.node, one.message, one.detail, one.attribute)
    postponed.clear()
