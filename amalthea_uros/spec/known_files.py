"""Files that a description refers to by name: those that come with amuros, and those of users."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.repair import CERTAIN

_SUFFIXES = (".yaml", ".yml")


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownFiles:
    """Files of one kind that come with amuros.

    Attributes
    ----------
    kind : what they describe, for messages
    folder : where they are
    names : without the suffix
    advice : what to do about an unknown name, besides using a known one
    """

    kind: str
    folder: Path
    names: Sequence[str]
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
            path = folder / name
            if path.is_file():
                return path, ()
            message = f"{self.kind} file {str(path)!r} not found"
            raise ReadError([_undefined(message, "Give a path relative to the directory of this file.", location)])
        if name in self.names:
            return self._known(name), ()
        near = similar(name, self.names)
        others = f"Known {self.kind}s: {', '.join(self.names)}; {self.advice}"
        finding = _undefined(f"unknown {self.kind} {name!r}", f"Did you mean {near[0]!r}?" if near else others, location)
        if not similar(name, self.names, cutoff=CERTAIN):
            raise ReadError([finding])
        return self._known(near[0]), (finding,)

    def _known(self, name: str) -> Path:
        return self.folder / f"{name}.yaml"


def _undefined(message: str, advice: str, location: Location | None) -> Finding:
    return Finding("APP001", Severity.ERROR, message, location, advice)
