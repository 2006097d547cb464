"""The files of source code that paths stand for, and their text."""

from __future__ import annotations

import os
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import accumulate
from pathlib import Path

from amalthea_uros._internal.files import FileError, is_directory, read_bytes
from amalthea_uros._internal.limits import ADVICE, SOURCE_FILES, SOURCE_SIZE, SOURCES_SIZE
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError

_C = (".c",)
#: What is not C for certain is read as C++, which is nearly a superset.
_CPP = (".h", ".hpp", ".hh", ".cpp", ".cc", ".cxx", ".ino")
SUFFIXES = (*_C, *_CPP)
META = ".meta"
#: Files that define messages and services of an application: `package/msg/Name.msg`.
INTERFACES = (".msg", ".srv", ".action", ".idl")
#: Files of build systems that say something about the controller, by their names.
BUILD_FILES = (
    *("sdkconfig", "sdkconfig.defaults", "platformio.ini", "prj.conf", "CMakeLists.txt", "library.properties"),
    # Beside prj.conf, as amuros generate writes it.
    "amuros.conf",
)


@dataclass(frozen=True)
class SourceFile:
    """A file of source code.

    Attributes
    ----------
    text : its bytes; positions in syntax trees count bytes
    """

    path: Path
    text: bytes

    @property
    def is_c(self) -> bool:
        """Whether it is C, not C++."""
        return self.path.suffix.lower() in _C

    def location(self, row: int, column: int) -> Location:
        """A place in it, by row and column from 0, with the text of its line."""
        line = self._lines[row].decode("utf-8", "replace").rstrip("\r") if row < len(self._lines) else ""
        return Location(self.path, row + 1, column + 1, line)

    def location_at(self, position: int) -> Location:
        """The place of a byte."""
        row = bisect_right(self._starts, position) - 1
        return self.location(row, position - self._starts[row])

    @cached_property
    def _starts(self) -> list[int]:
        return [0, *accumulate(len(line) + 1 for line in self._lines)]

    @cached_property
    def _lines(self) -> list[bytes]:
        return self.text.split(b"\n")


@dataclass(frozen=True, slots=True)
class Sources:
    """All files that were given.

    Attributes
    ----------
    meta : files with build options of colcon
    build : other files of build systems
    interfaces : definitions of messages and services
    findings : files that cannot be read
    """

    code: tuple[SourceFile, ...]
    meta: tuple[SourceFile, ...]
    findings: tuple[Finding, ...]
    build: tuple[SourceFile, ...] = ()
    interfaces: tuple[SourceFile, ...] = ()


def read_sources(paths: Iterable[Path]) -> Sources:
    """Read files, and what is in folders.

    Raises
    ------
    ReadError : a path does not exist, there is no source code, or there is too much of it.
    """
    code: list[SourceFile] = []
    meta: list[SourceFile] = []
    build: list[SourceFile] = []
    interfaces: list[SourceFile] = []
    findings: list[Finding] = []
    size = 0
    for path in _found(paths):
        try:
            text = read_bytes(path, SOURCE_SIZE)
        except FileError as error:
            findings.append(_unreadable(path, error.reason, error.advice))
            continue
        if b"\0" in text:
            findings.append(_unreadable(path, "this is not text: it has zero bytes", "Give files of C or C++ source code."))
            continue
        size += len(text)
        if size > SOURCES_SIZE:
            raise ReadError([_unreadable(path, "there is too much source code", f"Give only the application. {ADVICE}")])
        if path.suffix in INTERFACES:
            interfaces.append(SourceFile(path, text))
            continue
        kind = build if path.name in BUILD_FILES else meta if path.suffix == META else code
        kind.append(SourceFile(path, text))
    if not code:
        advice = f"Give C or C++ files ({', '.join(SUFFIXES)}) or folders with them."
        raise ReadError(findings or [Finding("IMP002", Severity.ERROR, "there is no source code", None, advice)])
    return Sources(tuple(code), tuple(meta), tuple(findings), tuple(build), tuple(interfaces))


def _found(paths: Iterable[Path]) -> list[Path]:
    """The files that were named, and the source code in folders, each once."""
    found: dict[Path, None] = {}
    for path in paths:
        for each in sorted(_in_folder(path)) if is_directory(path) else [path]:
            found[each] = None
            if len(found) > SOURCE_FILES:
                raise ReadError([_unreadable(path, f"there are more than {SOURCE_FILES:,} files", f"Give fewer. {ADVICE}")])
    return list(found)


def _in_folder(folder: Path) -> Iterator[Path]:
    """Source code in a folder and those in it, without hidden ones; links are not followed out of it."""
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in names:
            if (name.lower().endswith((*SUFFIXES, META, *INTERFACES)) or name in BUILD_FILES) and not name.startswith("."):
                path = Path(place, name)
                if not path.is_symlink():
                    yield path


def _unreadable(path: Path, reason: str, advice: str) -> Finding:
    return Finding("IMP002", Severity.ERROR, reason, Location(path), advice)
