"""Models in another AMALTHEA version."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.limits import MODEL_SIZE
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.shown import Shown
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import AmurosError, ReadError, WriteError
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import newest_version
from amalthea_uros.names import require
from amalthea_uros.perf.named import Brief
from amalthea_uros.services.inputs import as_paths, refuse_descriptions
from amalthea_uros.services.migrated_paths import Destination, given_files
from amalthea_uros.services.migration import FileState, MigratedFile, MigrationChange, NoteKind
from amalthea_uros.services.migration_writer import Writer
from amalthea_uros.xmi.files import FileText
from amalthea_uros.xmi.load import SUFFIX
from amalthea_uros.xmi.migrate.load import MigratedSet, failed, losses_of_going_back, migrate_set
from amalthea_uros.xmi.migrate.sets import InputFile, sets_of
from amalthea_uros.xmi.migrate.versions import VERSIONS
from amalthea_uros.xmi.writer import document_text

#: The versions in which models can be written; nothing was ever migrated to the first one.
TARGETS = VERSIONS[1:]


@dataclass(frozen=True, slots=True, kw_only=True)
class MigrationResult(Brief, Shown):
    """Models in another version, and what was done for that.

    Attributes
    ----------
    version : the new version
    findings : why files were not written, and problems found while reading them
    sets : the files that belong together, unless they were written already
    given : the files and folders that were migrated
    """

    version: str
    files: tuple[MigratedFile, ...]
    changes: tuple[MigrationChange, ...]
    findings: tuple[Finding, ...]
    sets: tuple[MigratedSet, ...] = ()
    given: tuple[Path, ...] = ()

    @property
    def lost(self) -> tuple[MigrationChange, ...]:
        """What is not in the result."""
        return tuple(change for change in self.changes if change.kind is NoteKind.LOST)

    @property
    def is_complete(self) -> bool:
        """Whether every file was migrated."""
        return all(file.state is not FileState.FAILED for file in self.files)

    @property
    def models(self) -> tuple[Model, ...]:
        """The models, one for each set of files that refer to each other; none for versions before 0.9.7."""
        return tuple(one.model for one in self.sets if one.model is not None)

    @property
    def model(self) -> Model:
        """The only model.

        Raises
        ------
        ValueError : there are several, or none because the version has no typed classes.
        """
        models = self.models
        if len(models) != 1:
            reason = "; use models, or save()" if models else ": AMALTHEA before 0.9.7 has no typed classes; use save()"
            raise ValueError(f"the migration has {len(models)} models{reason}")
        return models[0]

    def save(
        self, target: StrPath | None = None, *, in_place: bool = False, force: bool = False, compress: bool | None = None
    ) -> MigrationResult:
        """Write the files.

        Parameters
        ----------
        target : the file, for a model of one file; the folder, for several. None: beside the old files, with the version in the
            name
        in_place : replace the old files
        force : overwrite files that exist
        compress : write a ZIP, or not; None: as it was read

        Raises
        ------
        WriteError : a file exists or cannot be written; then no file of its model is written.
        """
        goal = Destination.of(self.given, self.version, Path(target) if target is not None else None, in_place=in_place)
        writer = Writer(goal, force, compress, is_dry_run=False)
        files: list[MigratedFile] = []
        for one in self.sets:
            files += writer.write(one)
        return replace(self, files=tuple(files))


def migrate(source: Model | StrPath | Iterable[StrPath], to: str | None = None) -> MigrationResult:
    """Migrate models to another AMALTHEA version; nothing is written before `save` of the result.

    Parameters
    ----------
    source : a model, or files and folders
    to : the version, such as "2.0.0" or "ITEA 1.3.0"; the newest one if none is given

    Raises
    ------
    InvalidArgumentError : there is no such version.
    ReadError : a file cannot be read, or no migration leads to the version.
    WriteError : an older version cannot hold something.
    """
    version = _required(to)
    with paused_garbage_collection():
        if isinstance(source, Model):
            sets = [tuple(_of_model(source, version))]
            given = tuple(file.path for file in sets[0])
        else:
            given = as_paths(source)
            sets = _sets(given, version, ())
        wrong = [finding for files in sets for file in files for finding in file.findings]
        if wrong:
            raise ReadError(wrong)
        migrated = [_migrate(files, version) for files in sets]
    return MigrationResult(
        version=version,
        files=tuple(file for one in migrated for file in _files(one, FileState.MIGRATED)),
        changes=tuple(change for one in migrated for change in _changes(one)),
        findings=tuple(finding for one in migrated for finding in _findings(one)),
        sets=tuple(migrated),
        given=given,
    )


def migrate_files(
    paths: StrPath | Iterable[StrPath],
    to: str | None = None,
    target: StrPath | None = None,
    *,
    in_place: bool = False,
    force: bool = False,
    compress: bool | None = None,
    is_dry_run: bool = False,
    track: Callable[[Sequence[tuple[InputFile, ...]]], Iterable[tuple[InputFile, ...]]] = iter,
) -> MigrationResult:
    """Migrate files, and write them set by set: what is wrong with one set does not keep the others from being written.

    Parameters
    ----------
    to : as for `migrate`
    target, in_place, force, compress : as for `MigrationResult.save`
    is_dry_run : write nothing
    track : wraps the iteration over the sets, for example to show progress

    Raises
    ------
    InvalidArgumentError : there is no such version.
    ReadError : a folder has no models.
    """
    version = _required(to)
    given = as_paths(paths)
    refuse_descriptions(given)
    goal = Destination.of(given, version, Path(target) if target is not None else None, in_place=in_place)
    with paused_garbage_collection():
        sets = _sets(given, version, goal.folders())
        if target is None and all(file.version == version for files in sets for file in files):
            goal = replace(goal, in_place=True)  # nothing to do, so nothing to copy
        writer = Writer(goal, force, compress, is_dry_run)
        done: list[MigratedFile] = []
        changes: list[MigrationChange] = []
        findings: list[Finding] = []
        for files in track(sets):
            try:
                wrong = [finding for file in files for finding in file.findings]
                if wrong:
                    raise ReadError(wrong)
                migrated = _migrate(files, version)
                # Before the changes: nothing is lost from files that are not written.
                done += writer.write(migrated)
                changes += _changes(migrated)
                findings += _findings(migrated)
            except AmurosError as error:
                findings += error.findings
                done += _failed(files)
            except Exception as error:  # one bad file never stops the rest
                findings.append(failed(files[0].path, error))
                done += _failed(files)
    return MigrationResult(version=version, files=tuple(done), changes=tuple(changes), findings=tuple(findings))


def _required(to: str | None) -> str:
    if to is None:
        return newest_version()
    require("AMALTHEA version", [to], TARGETS)
    return to


def _sets(paths: Sequence[Path], version: str, excluded: Collection[Path]) -> list[tuple[InputFile, ...]]:
    inputs = (InputFile.read(file.path, file.scope, version, MODEL_SIZE) for file in given_files(paths, excluded))
    return sets_of(inputs, version, MODEL_SIZE)


def _of_model(model: Model, version: str) -> Iterable[InputFile]:
    """The documents of a model as they would be saved."""
    for number, document in enumerate(model.documents):
        path = document.path or Path(f"model{number or ''}{SUFFIX}")
        zip_entry = document.source.zip_entry if document.source else None
        yield InputFile.of(path, None, FileText(document_text(document), zip_entry=zip_entry), version)


def _migrate(files: Sequence[InputFile], version: str) -> MigratedSet:
    contents = [(file.path, file.content) for file in files if file.content is not None]
    migrated = migrate_set(contents, version, MODEL_SIZE)
    lost = losses_of_going_back(migrated)
    if lost:
        raise WriteError(lost)
    return migrated


def _changes(migrated: MigratedSet) -> Iterable[MigrationChange]:
    origins = migrated.models.origins
    for note in migrated.notes:
        yield MigrationChange(
            kind=note.kind,
            step=note.version,
            message=note.message,
            detail=note.detail,
            object=origins.object_name(note.origin),
            location=origins.location(note.origin, note.attribute),
        )


def _findings(migrated: MigratedSet) -> Sequence[Finding]:
    return migrated.model.findings if migrated.model is not None else ()


def _files(migrated: MigratedSet, state: FileState) -> Iterable[MigratedFile]:
    for tree, version in zip(migrated.models.trees, migrated.versions, strict=True):
        yield MigratedFile(path=tree.path, version=version, target=None, state=state)


def _failed(files: Iterable[InputFile]) -> Iterable[MigratedFile]:
    for file in files:
        yield MigratedFile(path=file.path, version=file.version, target=None, state=FileState.FAILED)
