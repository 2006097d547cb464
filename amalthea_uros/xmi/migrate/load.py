"""Files of a set in another version: as documents, as text, what was done for that, and what an older version cannot hold."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from amalthea_uros._internal.failures import failure
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import newest_version, spelled
from amalthea_uros.xmi.files import FileText
from amalthea_uros.xmi.migrate.chain import migrate, version_of_content
from amalthea_uros.xmi.migrate.model_set import ModelSet, Tree
from amalthea_uros.xmi.migrate.notes import Note, NoteKind, StepNotes
from amalthea_uros.xmi.migrate.read_set import read_set
from amalthea_uros.xmi.migrate.steps import DOWN
from amalthea_uros.xmi.migrate.tree_reader import read_trees
from amalthea_uros.xmi.migrate.versions import VERSIONS, is_known, is_older, position
from amalthea_uros.xmi.migrate.write import tree_text
from amalthea_uros.xmi.reader import ReadResult, read
from amalthea_uros.xmi.references import resolve
from amalthea_uros.xmi.writer import document_text


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
    max_size: int,
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


def read_migrated(files: Sequence[tuple[Path, FileText]], max_size: int, elsewhere: Collection[Path]) -> MigratedFiles:
    """Read files of older versions, and those to which they refer by file names.

    Parameters
    ----------
    elsewhere : files that are read as they are

    Raises
    ------
    ReadError : a file cannot be read; carries the findings of all of them.
    """
    migrated = migrate_set(files, newest_version(), max_size, elsewhere=elsewhere)
    results, linked = migrated.read()
    return MigratedFiles(results, linked, announcements(migrated))


def announcements(migrated: MigratedSet) -> list[Finding]:
    """That files were migrated in memory, and what was lost."""
    models = migrated.models
    places = [place for place in range(len(models.trees)) if not migrated.is_unchanged(place)]
    if not places:
        return []
    first = models.trees[places[0]]
    others = f" ({len(places)} files)" if len(places) > 1 else ""
    stated = ", ".join(dict.fromkeys(spelled(migrated.versions[place]) for place in places))
    files = "the files are" if len(places) > 1 else "the file is"
    message = f"{stated} was migrated to {migrated.target} in memory{others}; {files} unchanged"
    help_text = "`amuros migrate` writes the model in a newer version, with a report of what was converted."
    where = models.origins.location(first.root.origin)
    return [Finding("XMI008", Severity.INFO, message, where, help_text), *_losses(migrated)]


#: So many kinds of lost content are named; the report of the command names all.
_NAMED = 4


def _losses(migrated: MigratedSet) -> list[Finding]:
    """What the migration could not keep, in one finding at the first place."""
    lost = [note for note in migrated.notes if note.kind is NoteKind.LOST]
    if not lost:
        return []
    first = lost[0]
    numbers = Counter(note.message for note in lost)
    if len(numbers) == 1:
        detail = f": {first.detail}" if first.detail else ""
        what = f"{first.message}{detail}" + (f" ({len(lost):,} times, this is the first)" if len(lost) > 1 else "")
    else:
        named = [f"{message} ({number:,})" for message, number in numbers.most_common(_NAMED)]
        rest = f" and {len(numbers) - _NAMED} more kinds" if len(numbers) > _NAMED else ""
        what = f"{', '.join(named)}{rest}; this is the first place"
    origins = migrated.models.origins
    help_text = "The new version has no place for it. `amuros migrate --dry-run` lists everything that is converted or lost."
    where = origins.location(first.origin, first.attribute)
    message = f"lost in the migration to {migrated.target}: {what}"
    return [Finding("XMI009", Severity.WARNING, message, where, help_text, origins.object_name(first.origin))]


# Migration back: why it is refused

#: What the reader says about content that is not in the model: unknown, misplaced, wrong or given twice.
_NOT_IN_THE_MODEL = frozenset({"XMI010", "XMI011", "XMI012", "XMI013", "XMI014"})

#: So many objects are named for each thing that is lost; the others are counted.
_NAMED_OBJECTS = 20

_TIMES = re.compile(r" \((\d[\d,]*) times, this is the first\)$")
_VERSION = re.compile(r" ?\(?(?:of )?AMALTHEA [\d.]+\)?")


def losses_of_going_back(migrated: MigratedSet) -> list[Finding]:
    """An error for each thing that a set of files would lose; none if no file of it was newer before."""
    if not migrated.is_down:
        return []
    help_text = f"Remove it from the model, or choose a version newer than {migrated.target}."
    lost = list(_noted(migrated))
    places = {_place(where) for _, where, _ in lost}
    before = Counter(_keys(_findings_before(migrated)))
    for finding in migrated.model.findings if migrated.model else ():
        if finding.rule in _NOT_IN_THE_MODEL:
            key, number = _key(finding)
            # A step knows better than the reader what is lost.
            if number > before[key] and _place(finding.location) not in places:
                lost.append((finding.message, finding.location, finding.object))
    return [
        Finding("XMI102", Severity.ERROR, f"AMALTHEA {migrated.target} cannot hold this: {message}", where, help_text, name)
        for message, where, name in lost
    ]


def _place(where: Location | None) -> tuple[str, int | None, int | None] | None:
    return (str(where.path), where.line, where.column) if where is not None else None


def _noted(migrated: MigratedSet) -> Iterable[tuple[str, Location | None, str]]:
    origins = migrated.models.origins
    notes = [note for note in migrated.notes if note.kind is NoteKind.LOST and note.version]
    total = Counter(note.message for note in notes)
    named: Counter[str] = Counter()
    for note in notes:
        named[note.message] += 1
        if named[note.message] > _NAMED_OBJECTS:
            continue
        rest = total[note.message] - _NAMED_OBJECTS
        more = f" (and {rest:,} more of this kind)" if named[note.message] == _NAMED_OBJECTS and rest > 0 else ""
        message = f"{note.message}: {note.detail}" if note.detail else note.message
        yield message + more, origins.location(note.origin, note.attribute), origins.object_name(note.origin)


def _findings_before(migrated: MigratedSet) -> Iterable[Finding]:
    """What the files say in their own version."""
    for tree, version in zip(migrated.models.trees, migrated.versions, strict=True):
        if not is_older(version):
            try:
                yield from read(tree.path, tree.content).findings
            except ReadError:
                continue


def _keys(findings: Iterable[Finding]) -> dict[str, int]:
    found: dict[str, int] = {}
    for finding in findings:
        key, number = _key(finding)
        found[key] = found.get(key, 0) + number
    return found


def _key(finding: Finding) -> tuple[str, int]:
    """What a finding is about, whatever the version, and how often it occurs."""
    times = _TIMES.search(finding.message)
    text = _VERSION.sub("", _TIMES.sub("", finding.message))
    return f"{finding.rule} {text}", int(times[1].replace(",", "")) if times else 1
