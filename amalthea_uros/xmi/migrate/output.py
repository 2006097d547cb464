"""Where the results of a migration go: all files of a set are written, or none."""

from __future__ import annotations

from collections.abc import Collection
from enum import StrEnum
from pathlib import Path

from amalthea_uros._internal.files import is_directory, is_file, is_stream, not_writable, resolved
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.xmi.emf.files import SUFFIX, ZIP_ENTRY, write_texts
from amalthea_uros.xmi.emf.files import not_writable as write_error
from amalthea_uros.xmi.emf.versions import migrated_name
from amalthea_uros.xmi.migrate.load import MigratedSet


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
    target: Path | None = None
    state: FileState


@dataclass(frozen=True, slots=True, kw_only=True)
class Destination:
    """Where the results go.

    Attributes
    ----------
    version : the new version
    roots : the folders that were given
    file : the only result
    folder : what results go to, with the folders between a given folder and the file
    in_place : results replace the old files
    force : files that exist are overwritten
    compress : whether the files become ZIPs; None: as they were read
    is_dry_run : nothing is written
    sources : what was written, and from which file, so that no two files become one
    """

    version: str
    roots: tuple[Path, ...]
    file: Path | None
    folder: Path | None
    in_place: bool
    force: bool = False
    compress: bool | None = None
    is_dry_run: bool = False
    sources: dict[Path, Path] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        paths: Collection[Path],
        version: str,
        target: StrPath | None,
        *,
        in_place: bool,
        force: bool,
        compress: bool | None,
        is_dry_run: bool = False,
    ) -> Destination:
        """The destination for some paths; without a target, beside the old files."""
        roots = tuple(path for path in paths if is_directory(path))
        goal = None if target is None else Path(target)
        is_file = goal is not None and len(paths) == 1 and not roots and not is_directory(goal)
        return cls(
            version=version,
            roots=roots,
            file=goal if is_file else None,
            folder=None if is_file else goal,
            in_place=in_place,
            force=force,
            compress=compress,
            is_dry_run=is_dry_run,
        )

    def folders(self) -> set[Path]:
        """The folders of results, which may be inside of those that are migrated."""
        return {resolved(self._beside(root)) for root in self.roots} | ({resolved(self.folder)} if self.folder else set())

    def write(self, migrated: MigratedSet) -> list[MigratedFile]:
        """Write all files of a set or none.

        Raises
        ------
        ReadError, WriteError : it cannot be written.
        """
        trees = migrated.models.trees
        state = FileState.PLANNED if self.is_dry_run else FileState.WRITTEN
        done: list[MigratedFile] = []
        contents: dict[Path, FileText] = {}
        removed: list[Path] = []
        for place, (tree, text, version) in enumerate(zip(trees, migrated.texts(), migrated.versions, strict=True)):
            target = self._target(tree.path, has_others=len(trees) > 1)
            if migrated.is_unchanged(place) and self._leaves_what_is_unchanged(tree.path):
                done.append(MigratedFile(path=tree.path, version=version, state=FileState.AS_IS))
                continue
            self._claim(target, tree.path)
            if self.compress is not None:
                text = FileText(text.text, text.encoding, (text.zip_entry or ZIP_ENTRY) if self.compress else None)
            contents[target] = text
            if self.in_place and target != tree.path:
                removed.append(tree.path)
            done.append(MigratedFile(path=tree.path, version=version, target=target, state=state))
        if not self.is_dry_run:
            self._make_folders(contents)
            write_texts(contents, removed)
        return done

    def _target(self, path: Path, has_others: bool) -> Path:
        """The file for the result of a file, which may have other files in its set."""
        name = migrated_name(path.name, self.version)
        if self.in_place:
            return path.with_name(name)
        if self.file is not None and not has_others:
            return self.file
        if self.file is not None and self.file.suffix == SUFFIX:
            message = f"{path} and the files to which it refers cannot be written to one file"
            raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(self.file), "Give a folder with -o.")])
        root, below = self._place(path) or (None, Path())
        folder = self.file or self.folder or (self._beside(root) if root is not None else None)
        if folder is None:
            plain = Path(name)
            return path.with_name(f"{plain.stem}-{self._label}{plain.suffix}")
        return folder / below / name

    def _leaves_what_is_unchanged(self, path: Path) -> bool:
        """Whether a file that has the version already is not copied."""
        return self.in_place or (self.file is None and self.folder is None and self._place(path) is None)

    def _claim(self, target: Path, source: Path) -> None:
        """Refuse to write a file twice, or over a file that exists."""
        place = resolved(target)
        other = self.sources.setdefault(place, source)
        if other != source:
            message = f"two files would be written here: {other} and {source}"
            help_text = "Migrate them one by one, or rename one of them."
            raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(target), help_text)])
        is_itself = self.in_place and place == resolved(source)
        if is_file(target) and not is_stream(target) and not self.force and not is_itself:
            message = "the file exists already"
            help_text = "Use --force to overwrite it, --in-place to replace the old file, or write to another place with -o."
            raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(target), help_text)])

    def _make_folders(self, targets: Collection[Path]) -> None:
        """Make the folders of some files; only below the folder for the results."""
        if self.file is not None and self.file in targets:
            return
        for folder in {target.parent for target in targets}:
            try:
                folder.mkdir(parents=True, exist_ok=True)
            except (OSError, ValueError) as error:
                raise write_error(not_writable(folder, error)) from None

    @property
    def _label(self) -> str:
        return self.version.replace(" ", "-")

    def _place(self, path: Path) -> tuple[Path, Path] | None:
        """The given folder in which a file is, and the way from there to the folder of the file."""
        for root in self.roots:
            # A link is where it was found; a file that another one names may be written as if it were elsewhere.
            for file, folder in ((path, root), (resolved(path), resolved(root))):
                if file.is_relative_to(folder) and ".." not in (below := file.relative_to(folder)).parts:
                    return root, below.parent
        return None

    def _beside(self, root: Path) -> Path:
        """The folder for the results of a folder, without a target."""
        # `.` and `..` are not what the folder is called.
        place = resolved(root) if root.name in ("", "..") else root
        return place.parent / f"{place.name}-{self._label}"
