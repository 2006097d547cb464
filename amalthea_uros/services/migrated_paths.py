"""Which files are migrated, and where the result of each goes."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from amalthea_uros._internal.files import FileError, is_directory, is_file, not_writable, resolved
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.xmi.files import not_readable
from amalthea_uros.xmi.files import not_writable as write_error
from amalthea_uros.xmi.load import SUFFIX, is_model_name


class GivenFile(NamedTuple):
    """A file, and the folder in whose files it may find what it refers to by name; None: the other files that were given."""

    path: Path
    scope: Path | None


def given_files(paths: Iterable[Path], excluded: Collection[Path]) -> list[GivenFile]:
    """The files that some paths stand for; a folder stands for all models in it and in its folders.

    Parameters
    ----------
    excluded : folders that are left out

    Raises
    ------
    ReadError : a folder has no models.
    """
    found: dict[Path, GivenFile] = {}
    for path in paths:
        if not is_directory(path):
            found.setdefault(resolved(path), GivenFile(path, None))
            continue
        models = list(_models_below(path, excluded))
        for file in models:
            found.setdefault(resolved(file), GivenFile(file, file.parent))
        if not models:
            raise not_readable(FileError(path, f"the directory contains no {SUFFIX} file"))
    return list(found.values())


def _models_below(folder: Path, excluded: Collection[Path]) -> Iterator[Path]:
    for name, folders, files in os.walk(folder):
        holder = Path(name)
        folders[:] = sorted(each for each in folders if not each.startswith(".") and resolved(holder / each) not in excluded)
        models = (holder / file for file in sorted(files) if is_model_name(Path(file)))
        # Reading a pipe never ends; a link that leads nowhere is reported.
        yield from (file for file in models if is_file(file) or file.is_symlink())


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
    """

    version: str
    roots: tuple[Path, ...]
    file: Path | None
    folder: Path | None
    in_place: bool

    @classmethod
    def of(cls, paths: Collection[Path], version: str, target: Path | None, *, in_place: bool) -> Destination:
        """The destination for some paths; without a target, beside the old files."""
        roots = tuple(path for path in paths if is_directory(path))
        is_file = target is not None and len(paths) == 1 and not roots and not is_directory(target)
        return cls(
            version=version,
            roots=roots,
            file=target if is_file else None,
            folder=None if is_file else target,
            in_place=in_place,
        )

    def folders(self) -> set[Path]:
        """The folders of results, which may be inside of those that are migrated."""
        return {resolved(self._beside(root)) for root in self.roots} | ({resolved(self.folder)} if self.folder else set())

    def target(self, path: Path, name: str, has_others: bool) -> Path:
        """The file for the result of a file.

        Parameters
        ----------
        name : what a file of that name is called in the new version
        has_others : whether there are other files in its set

        Raises
        ------
        WriteError : several files cannot become one.
        """
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

    def leaves_what_is_unchanged(self, path: Path) -> bool:
        """Whether a file that has the version already is not copied."""
        return self.in_place or (self.file is None and self.folder is None and self._place(path) is None)

    def make_folders(self, targets: Iterable[Path]) -> None:
        """Make the folders of some files; only below the folder for the results.

        Raises
        ------
        WriteError : a folder cannot be made.
        """
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
