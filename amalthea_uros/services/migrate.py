"""Models in another AMALTHEA version."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from pathlib import Path

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import AmurosError
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import newest_version
from amalthea_uros.names import require
from amalthea_uros.perf.named import Brief
from amalthea_uros.services.inputs import as_paths, refuse_descriptions
from amalthea_uros.xmi.emf.versions import VERSIONS
from amalthea_uros.xmi.migrate.load import MigratedSet, failed
from amalthea_uros.xmi.migrate.output import Destination
from amalthea_uros.xmi.migrate.output import FileState as FileState
from amalthea_uros.xmi.migrate.output import MigratedFile as MigratedFile
from amalthea_uros.xmi.migrate.sets import InputFile, migrate_inputs, refuse_unreadable, set_of_model, sets_of
from amalthea_uros.xmi.tree.notes import MigrationChange as MigrationChange
from amalthea_uros.xmi.tree.notes import NoteKind as NoteKind

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
        goal = Destination.of(self.given, self.version, target, in_place=in_place, force=force, compress=compress)
        return replace(self, files=tuple(chain.from_iterable(map(goal.write, self.sets))))


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
            sets = [set_of_model(source, version)]
            given = tuple(file.path for file in sets[0])
        else:
            given = as_paths(source)
            sets = sets_of(given, version)
        refuse_unreadable(chain.from_iterable(sets))
        migrated = [migrate_inputs(files, version) for files in sets]
    return MigrationResult(
        version=version,
        files=tuple(
            MigratedFile(path=tree.path, version=before, state=FileState.MIGRATED)
            for one in migrated
            for tree, before in zip(one.models.trees, one.versions, strict=True)
        ),
        changes=tuple(change for one in migrated for change in one.changes()),
        findings=tuple(finding for one in migrated if one.model is not None for finding in one.model.findings),
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
    goal = Destination.of(given, version, target, in_place=in_place, force=force, compress=compress, is_dry_run=is_dry_run)
    with paused_garbage_collection():
        sets = sets_of(given, version, goal.folders())
        if target is None and all(file.version == version for files in sets for file in files):
            goal = replace(goal, in_place=True)  # nothing to do, so nothing to copy
        done: list[MigratedFile] = []
        changes: list[MigrationChange] = []
        findings: list[Finding] = []
        for files in track(sets):
            try:
                migrated = migrate_inputs(files, version)
                # Before the changes: nothing is lost from files that are not written.
                done += goal.write(migrated)
                changes += migrated.changes()
                findings += migrated.model.findings if migrated.model is not None else ()
                continue
            except AmurosError as error:
                findings += error.findings
            except Exception as error:  # one bad file never stops the rest
                findings.append(failed(files[0].path, error))
            done += (MigratedFile(path=file.path, version=file.version, state=FileState.FAILED) for file in files)
    return MigrationResult(version=version, files=tuple(done), changes=tuple(changes), findings=tuple(findings))


def _required(to: str | None) -> str:
    if to is None:
        return newest_version()
    require("AMALTHEA version", [to], TARGETS)
    return to
