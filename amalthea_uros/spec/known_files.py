"""Files that come with amuros, which descriptions refer to by name, beside files of users."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.mistakes import CERTAIN

_SUFFIXES = (".yaml", ".yml")


def named_file(kind: str, name: str, folder: Path, location: Location | None) -> Path:
    """A file of users that a description names.

    Parameters
    ----------
    kind : of the file, for the message
    folder : that the name is relative to
    location : where the name is stated

    Raises
    ------
    ReadError : there is no such file.
    """
    path = folder / name
    if path.is_file():
        return path
    advice = "Give a path relative to the directory of this file."
    raise ReadError([Finding("APP001", Severity.ERROR, f"{kind} {str(path)!r} not found", location, advice)])


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownFiles:
    """Files of one kind that come with amuros.

    Attributes
    ----------
    kind : what they describe, for messages
    files : by name
    advice : what to do about an unknown name, besides using a known one
    """

    kind: str
    files: Mapping[str, Path]
    advice: str

    def find(self, name: str, folder: Path, location: Location | None) -> tuple[Path, tuple[Finding, ...]]:
        """The file of a name, and what is wrong with the name if it is clear which one is meant.

        Parameters
        ----------
        folder : that files of users are relative to
        location : where the name is stated

        Raises
        ------
        ReadError : there is no such file.
        """
        if name.endswith(_SUFFIXES):
            return named_file(f"{self.kind} file", name, folder, location), ()
        if name in self.files:
            return self.files[name], ()
        finding = self.unknown(name, location)
        near = similar(name, self.files, cutoff=CERTAIN)
        if not near:
            raise ReadError([finding])
        return self.files[near[0]], (finding,)

    def unknown(self, name: str, location: Location | None) -> Finding:
        """The finding about a name that none of the files has."""
        near = similar(name, self.files)
        others = f"Known {self.kind}s: {', '.join(self.files)}; {self.advice}"
        advice = f"Did you mean {near[0]!r}?" if near else others
        return Finding("APP001", Severity.ERROR, f"unknown {self.kind} {name!r}", location, advice)
