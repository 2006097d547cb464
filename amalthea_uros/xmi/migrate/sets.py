"""Which files are migrated together: those that refer to each other, by file names or by the names of objects."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote, unquote_plus
from xml.sax.saxutils import unescape

from amalthea_uros._internal.files import is_file, resolved
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.naming import TYPE_MARK
from amalthea_uros.xmi.files import FileText, read_text
from amalthea_uros.xmi.migrate.link import file_of
from amalthea_uros.xmi.migrate.load import refusals
from amalthea_uros.xmi.migrate.read_set import SUFFIX
from amalthea_uros.xmi.migrate.versions import version_of

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
    def read(cls, path: Path, scope: Path | None, target: str, max_size: int) -> InputFile:
        """Read a file; what is wrong with it becomes its findings."""
        try:
            content = read_text(path, max_size)
        except ReadError as error:
            return cls(path, scope, None, "", error.findings)
        return cls.of(path, scope, content, target)

    @classmethod
    def of(cls, path: Path, scope: Path | None, content: FileText, target: str) -> InputFile:
        """A file whose content is known already."""
        version = version_of(content.text)
        findings = tuple(refusals(path, content, version, target))
        return cls(path, scope, None if findings else content, version, findings)


def sets_of(files: Iterable[InputFile], target: str, max_size: int) -> list[tuple[InputFile, ...]]:
    """The files in sets, with those to which they refer by file names; in the order of the first file of each."""
    return _Sets(list(files), target, max_size).sets()


class _Sets:
    def __init__(self, files: list[InputFile], target: str, max_size: int) -> None:
        self.files, self.target, self.max_size = files, target, max_size
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
                self.files.append(InputFile.read(path, path.parent, self.target, self.max_size))
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
