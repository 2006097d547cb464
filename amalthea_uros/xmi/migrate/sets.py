"""Which files are migrated together: those that refer to each other, by file names or by the names of objects."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path
from urllib.parse import unquote, unquote_plus
from xml.sax.saxutils import unescape

from amalthea_uros._internal.files import FileError, is_directory, is_file, resolved
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import ReadError, WriteError
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.naming import TYPE_MARK
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.xmi.emf.files import SUFFIX, is_model_name, not_readable, read_text
from amalthea_uros.xmi.emf.versions import version_of
from amalthea_uros.xmi.emf.writer import document_text
from amalthea_uros.xmi.migrate.load import MigratedSet, migrate_set, refusals
from amalthea_uros.xmi.migrate.losses import losses_of_going_back
from amalthea_uros.xmi.tree.link import file_of

_HREF = re.compile(r"""\shref\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_NAME = re.compile(r"""\sname\s*=\s*(?:"([^"]*)"|'([^']*)')""")


@dataclass(frozen=True, eq=False)
class InputFile:
    """A file that is to be migrated.

    Attributes
    ----------
    scope : the folder whose other files may contain the objects to which this one refers by name; None: those given with it
    content : None if the file cannot be read or migrated
    version : the one that it declares, "" if unknown
    findings : why it cannot be read or migrated
    """

    path: Path
    scope: Path | None
    content: FileText | None
    version: str
    findings: tuple[Finding, ...] = ()

    @classmethod
    def read(cls, path: Path, scope: Path | None, target: str) -> InputFile:
        """Read a file; what is wrong with it becomes its findings."""
        try:
            content = read_text(path)
        except ReadError as error:
            return cls(path, scope, None, "", error.findings)
        return cls.of(path, scope, content, target)

    @classmethod
    def of(cls, path: Path, scope: Path | None, content: FileText, target: str) -> InputFile:
        """A file whose content is known already."""
        version = version_of(content.utf8)
        findings = tuple(refusals(path, content, version, target))
        return cls(path, scope, None if findings else content, version, findings)


def sets_of(paths: Iterable[Path], target: str, excluded: Collection[Path] = ()) -> list[tuple[InputFile, ...]]:
    """The files that some paths stand for, and those to which they refer by file names, in the order of the first file of each set.

    Parameters
    ----------
    paths : files and folders; a folder stands for all models in it and in its folders
    target : the version to which they are migrated
    excluded : folders that are left out

    Raises
    ------
    ReadError : a folder has no models.
    """
    scopes: dict[Path, tuple[Path, Path | None]] = {}
    for path in paths:
        if not is_directory(path):
            scopes.setdefault(resolved(path), (path, None))
            continue
        models = list(_models_below(path, excluded))
        for file in models:
            scopes.setdefault(resolved(file), (file, file.parent))
        if not models:
            raise not_readable(FileError(path, f"the directory contains no {SUFFIX} file"))
    return _Sets([InputFile.read(path, scope, target) for path, scope in scopes.values()], target).sets()


def _models_below(folder: Path, excluded: Collection[Path]) -> Iterator[Path]:
    for name, folders, files in os.walk(folder):
        holder = Path(name)
        folders[:] = sorted(each for each in folders if not each.startswith(".") and resolved(holder / each) not in excluded)
        models = (holder / file for file in sorted(files) if is_model_name(Path(file)))
        # Reading a pipe never ends; a link that leads nowhere is reported.
        yield from (file for file in models if is_file(file) or file.is_symlink())


def set_of_model(model: Model, target: str) -> tuple[InputFile, ...]:
    """The documents of a model as they would be saved."""
    inputs = []
    for number, document in enumerate(model.documents):
        path = document.path or Path(f"model{number or ''}{SUFFIX}")
        zip_entry = document.source.file.zip_entry if document.source else None
        inputs.append(InputFile.of(path, None, FileText(document_text(document), zip_entry=zip_entry), target))
    return tuple(inputs)


class _Sets:
    def __init__(self, files: list[InputFile], target: str) -> None:
        self.files, self.target = files, target
        self.places = {resolved(file.path): place for place, file in reversed(list(enumerate(files)))}
        #: The representative of the set of each file.
        self.leaders = list(range(len(files)))
        self.names: dict[Path | None, dict[str, list[int]]] = {}

    def sets(self) -> list[tuple[InputFile, ...]]:
        wanted = []
        # The list grows while files are found.
        for place, file in enumerate(self.files):
            if file.content is not None:
                wanted.append((place, self.join_files(place, file, _texts(_HREF, file.content.text))))
        for place, names in wanted:
            if names:
                self.join_names(place, names)
        found: dict[int, list[InputFile]] = {}
        for place, file in enumerate(self.files):
            found.setdefault(self.leader(place), []).append(file)
        return [tuple(members) for members in found.values()]

    def join_files(self, place: int, file: InputFile, hrefs: Sequence[str]) -> set[str]:
        """Join a file with those that it names; the names of the objects for which it leaves the search to the reader."""
        names = set()
        for href in hrefs:
            other = file_of(href)
            if not other:
                names.add(_name(href))
                continue
            path = file.path.parent / other
            if SUFFIX not in path.suffix or not is_file(path):
                continue  # a missing file is reported with the references to it
            found = self.places.get(resolved(path))
            if found is None:
                found = self.places[resolved(path)] = len(self.files)
                self.files.append(InputFile.read(path, path.parent, self.target))
                self.leaders.append(found)
            self.join(place, found)
        return names

    def join_names(self, place: int, names: set[str]) -> None:
        """Join a file with the others in its scope that define a name."""
        scope = self.files[place].scope
        if scope not in self.names:
            self.names[scope] = self.defined(scope)
        for name in names:
            defined = self.names[scope].get(name, ())
            # Some converters wrote references within a file in this form, too.
            if place not in defined:
                for other in defined:
                    self.join(place, other)

    def defined(self, scope: Path | None) -> dict[str, list[int]]:
        """The files of a scope that have objects of a name."""
        found: dict[str, list[int]] = {}
        for place, file in enumerate(self.files):
            if file.scope == scope and file.content is not None:
                for name in _texts(_NAME, file.content.text):
                    found.setdefault(name, []).append(place)
        return found

    def leader(self, place: int) -> int:
        while self.leaders[place] != place:
            self.leaders[place] = self.leaders[self.leaders[place]]
            place = self.leaders[place]
        return place

    def join(self, one: int, other: int) -> None:
        first, second = sorted((self.leader(one), self.leader(other)))
        self.leaders[second] = first


def _texts(attribute: re.Pattern[str], text: str) -> list[str]:
    """The different values of an attribute."""
    values = dict.fromkeys(match[1] or match[2] or "" for match in attribute.finditer(text))
    return [unescape(value, {"&quot;": '"', "&apos;": "'"}) if "&" in value else value for value in values]


def _name(href: str) -> str:
    """The name of the object that a reference means."""
    text = href.rpartition("#")[2]
    if TYPE_MARK not in text:
        text = unquote(text)
    return unquote_plus(text.rpartition(TYPE_MARK)[0].rpartition("/")[2])


def refuse_unreadable(files: Iterable[InputFile]) -> None:
    """Raise a `ReadError` with everything that keeps files from being read or migrated."""
    findings = [finding for file in files for finding in file.findings]
    if findings:
        raise ReadError(findings)


def migrate_inputs(files: Sequence[InputFile], target: str) -> MigratedSet:
    """Migrate the files of a set.

    Raises
    ------
    ReadError : a file cannot be read, or no migration leads to the version.
    WriteError : an older version cannot hold something.
    """
    refuse_unreadable(files)
    migrated = migrate_set([(file.path, file.content) for file in files if file.content is not None], target)
    lost = losses_of_going_back(migrated)
    if lost:
        raise WriteError(lost)
    return migrated
