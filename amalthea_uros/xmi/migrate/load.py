"""Files of a set in another version: as documents, as text, what was done for that, and what an older version cannot hold."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from amalthea_uros._internal.failures import failure
from amalthea_uros._internal.limits import MODEL_SIZE
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.xmi.emf.reader import ReadResult, read
from amalthea_uros.xmi.emf.references import resolve
from amalthea_uros.xmi.emf.versions import VERSIONS, is_known, is_older, position
from amalthea_uros.xmi.emf.writer import document_text
from amalthea_uros.xmi.migrate.chain import migrate, version_of_content
from amalthea_uros.xmi.migrate.steps import DOWN
from amalthea_uros.xmi.tree.link import read_set
from amalthea_uros.xmi.tree.model_set import ModelSet, Tree
from amalthea_uros.xmi.tree.notes import MigrationChange, Note, StepNotes
from amalthea_uros.xmi.tree.results import read_trees, tree_text


class MigratedSet:
    """Files that were migrated together.

    Attributes
    ----------
    models : their content in the new version
    versions : the versions of the files before
    target : the new version
    notes : what was done
    """

    def __init__(self, models: ModelSet, versions: Sequence[str], target: str, notes: Sequence[Note], as_is: set[int]) -> None:
        self.models, self.versions, self.target, self.notes = models, versions, target, notes
        self._as_is = as_is

    @property
    def is_down(self) -> bool:
        """Whether a file was newer before."""
        return any(position(version) > position(self.target) for version in self.versions)

    @cached_property
    def model(self) -> Model | None:
        """The files as one model, with the findings of reading them; None in versions that the classes do not cover.

        Raises
        ------
        ReadError : a file is not a whole model.
        """
        if is_older(self.target):
            return None
        results, linked = self.read()
        model = Model(result.document for result in results)
        model.findings = tuple(resolve(results, linked))
        return model

    def read(self) -> tuple[list[ReadResult], dict[str, Element]]:
        """The files as documents whose references are not yet resolved, and the objects by the texts of the references to them.

        Raises
        ------
        ReadError : a file is not a whole model.
        """
        results, linked = read_trees(self.models, self.versions)
        for place, result in enumerate(results):
            document = result.document
            if self.is_unchanged(place):
                document.migrated_from = None
            elif document.source is not None and document.source.version == document.version:
                # It has content of an older version than it declares: the text must not be used again.
                document.source = replace(document.source, version="")
        return results, linked

    def is_unchanged(self, place: int) -> bool:
        """Whether a file had the new version before, and refers to no file that had another one."""
        return place in self._as_is

    def changes(self) -> Iterator[MigrationChange]:
        """What was done, with the objects to which it was done."""
        origins = self.models.origins
        for note in self.notes:
            yield MigrationChange(
                kind=note.kind,
                step=note.version,
                message=note.message,
                detail=note.detail,
                object=origins.object_name(note.origin),
                location=origins.location(note.origin, note.attribute),
            )

    def texts(self) -> list[FileText]:
        """The content of each file in the new version.

        Raises
        ------
        ReadError : a file is not a whole model.
        WriteError : the new version does not allow something.
        """
        found = []
        for place, tree in enumerate(self.models.trees):
            if self.is_unchanged(place):
                found.append(tree.content)
                continue
            text = document_text(self.model.documents[place], canonical=True) if self.model else tree_text(tree)
            found.append(FileText(text, zip_entry=tree.content.zip_entry))
        return found


def migrate_set(
    files: Sequence[tuple[Path, FileText]],
    target: str,
    max_size: int = MODEL_SIZE,
    elsewhere: Collection[Path] = (),
) -> MigratedSet:
    """Migrate files, and those to which they refer by file names.

    Parameters
    ----------
    elsewhere : files that are read in another way, and that do not become part of the set

    Raises
    ------
    ReadError : a file cannot be read, or no migration leads to the version; carries the findings of all of them.
    """
    notes = StepNotes()
    models = read_set(files, max_size, notes, elsewhere)
    refused = [
        finding
        for tree in models.trees
        for finding in refusals(tree.path, tree.content, tree.version, target, models.origins.location(tree.root.origin))
    ]
    if refused:
        raise ReadError(refused)
    versions = [tree.version for tree in models.trees]
    begin = [version_of_content(tree, target) for tree in models.trees]
    try:
        migrate(models, target, notes)
    except Exception as error:
        raise ReadError([failed(models.trees[0].path, error)]) from error
    refused = [finding for tree in models.trees for finding in _fragment(tree, models, target)]
    if refused:
        raise ReadError(refused)
    same = {place for place, version in enumerate(begin) if version == target}
    if len(same) < len(begin):
        same = {place for place in same if not _refers_to_others(models, place, same)}
    return MigratedSet(models, versions, target, notes.all, same)


def failed(path: Path, error: Exception) -> Finding:
    """The finding for an error of ours, which must end neither the whole run nor a command without words."""
    if isinstance(error, MemoryError):
        message = "there is not enough memory for the migration"
        return Finding(
            "XMI105", Severity.ERROR, message, Location(path), "Migrate fewer files at once, or on a larger machine."
        )
    help_text = "This is an error in amuros; please report it together with the model."
    return Finding("XMI105", Severity.ERROR, f"the migration failed: {failure(error)}", Location(path), help_text)


def refusals(path: Path, content: FileText, version: str, target: str, where: Location | None = None) -> Sequence[Finding]:
    """Why a file of some version cannot be migrated; nothing if it can be."""
    where = where or Location(path)
    if not is_known(version):
        try:
            read(path, content)
        except ReadError as error:
            return error.findings
        message = f"{spelled(version)} is not a known version, so it cannot be migrated"
        help_text = f"Correct the version in the namespace of the root element; the newest known one is {VERSIONS[-1]}."
        return [Finding("XMI103", Severity.ERROR, message, where, help_text)]
    lowest = DOWN[-1].target
    if position(target) < min(position(version), position(lowest)):
        message = f"{spelled(version)} cannot be migrated to the older version {target}"
        if position(version) > position(lowest):
            help_text = f"Choose {lowest} or newer: no model is taken further back."
        else:
            help_text = f"Choose {version} or newer: only models newer than {lowest} are taken back."
        return [Finding("XMI103", Severity.ERROR, message, where, help_text)]
    return []


def _fragment(tree: Tree, models: ModelSet, target: str) -> Sequence[Finding]:
    """That a file holds neither a model nor a sub-model, but only a part of one; of no matter in versions without classes."""
    if tree.root.tag == "Amalthea" or is_older(target):
        return []
    origin = tree.root.origin
    message = f"not a whole model: the root element is a {models.origins.labels[origin][0]}"
    help_text = (
        "Only models are migrated, whose root is AMALTHEA or Amalthea; up to 0.7.2 also sub-models, with the roots SWModel, HWModel "
        "and so on."
    )
    return [Finding("XMI005", Severity.ERROR, message, models.origins.location(origin), help_text)]


def _refers_to_others(models: ModelSet, place: int, same: set[int]) -> bool:
    """Whether a file refers to one that was changed, so that the text of a reference may be another now."""
    unchanged = {models.trees[other].root for other in same}
    for node in models.trees[place].root.walk():
        for targets in node.references.values():
            if any(not target.is_proxy and target.root not in unchanged for target in targets):
                return True
    return False
