"""Files of older versions -> documents of the newest one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.versions import newest_version
from amalthea_uros.xmi.files import FileText
from amalthea_uros.xmi.migrate.chain import migrate
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Kind, Note, Notes
from amalthea_uros.xmi.migrate.read_set import read_set
from amalthea_uros.xmi.migrate.tree_reader import read_trees
from amalthea_uros.xmi.reader import ReadResult


class MigratedFiles(NamedTuple):
    """Files of older versions as documents of the newest one.

    Attributes
    ----------
    linked : objects by the texts of the references to them
    findings : that the files were migrated, and what was lost
    """

    results: list[ReadResult]
    linked: dict[str, Element]
    findings: list[Finding]


def read_migrated(files: Sequence[tuple[Path, FileText]], max_size: int) -> MigratedFiles:
    """Read files of older versions, and those to which they refer by file names.

    Raises
    ------
    ReadError : a file cannot be read; carries the findings of all of them.
    """
    notes = Notes()
    models = read_set(files, max_size, notes)
    versions = [tree.version for tree in models.trees]
    migrate(models, newest_version(), notes, official=False)
    results, linked = read_trees(models, versions)
    return MigratedFiles(results, linked, [*_announced(models, versions), *_losses(models, notes.all)])


def _announced(models: ModelSet, versions: Sequence[str]) -> list[Finding]:
    """One finding for all files: that they were migrated."""
    first = models.trees[0]
    others = f" ({len(models.trees)} files)" if len(models.trees) > 1 else ""
    stated = ", ".join(dict.fromkeys(versions))
    message = f"AMALTHEA {stated} was migrated to {first.version} in memory{others}; the file is unchanged"
    help_text = "`amuros migrate` writes the model in a newer version, with a report of what was converted."
    return [Finding("XMI008", Severity.INFO, message, models.origins.location(first.root.origin), help_text)]


def _losses(models: ModelSet, notes: Sequence[Note]) -> list[Finding]:
    """What the migration could not keep: one finding for each kind of thing, at the first."""
    by_message: dict[str, list[Note]] = {}
    for note in notes:
        if note.kind is Kind.LOST:
            by_message.setdefault(note.message, []).append(note)
    found = []
    for message, lost in by_message.items():
        first = lost[0]
        times = f" ({len(lost)} times, this is the first)" if len(lost) > 1 else ""
        detail = f": {first.detail}" if first.detail else ""
        text = f"lost in the migration to {first.version}: {message}{detail}{times}"
        where = models.origins.location(first.origin, first.attribute)
        help_text = "Newer versions have no place for it. `amuros migrate --dry-run` lists all that is converted and lost."
        found.append(Finding("XMI009", Severity.WARNING, text, where, help_text, models.origins.object_name(first.origin)))
    return found
