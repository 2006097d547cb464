"""A step from one version to a neighbouring one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import StepNotes

#: Changes the active files of the set.
Change = Callable[[ModelSet, StepNotes], None]


@dataclass(frozen=True)
class Step:
    """How the content of one version becomes that of a neighbouring one.

    Attributes
    ----------
    source, target : the versions
    change : what has to be done, None if only the namespace differs
    leftovers : tags and types (`xsi:type`) that do not occur any more after this step. In public histories the namespace was raised
        when the work on a version began, so a file of a later version in which one occurs takes this step, too; a step leaves alone
        what is already converted
    """

    source: str
    target: str
    change: Change | None = None
    leftovers: frozenset[str] = frozenset()
