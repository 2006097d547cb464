"""What callers of the library give: paths, a text, the content of a description, a model, or a system."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeGuard

from amalthea_uros._internal.files import read_text
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.paths import TEXT, StrPath, is_description
from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import SystemInput, as_paths, described_input, open_system

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Model

Subject: TypeAlias = "StrPath | Iterable[StrPath] | Mapping[str, Any] | Model | System"

_ACCEPTED = (
    "the path of an app.yaml or .amxmi file, a list of paths, the text of an app.yaml, its content as a dict, a Model, "
    "or a System such as taskset() makes"
)


def open_subject(subject: Subject) -> SystemInput:
    """The system of files, of a description as text or dict, of an AMALTHEA model, or the given one, with the findings about it.

    A text with a line break is the content of an `app.yaml`; any other text is a path.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    TypeError : the subject is something else; the text lists what is accepted.
    """
    if isinstance(subject, System):
        return SystemInput(system=subject, model=None, findings=())
    from amalthea_uros.metamodel.model import Model

    if isinstance(subject, Model):
        from amalthea_uros.bridge.extract import extract

        extraction = extract(subject)
        return SystemInput(system=extraction.system, model=subject, findings=(*subject.findings, *extraction.findings))
    if isinstance(subject, Mapping) or _is_text(subject):
        from amalthea_uros.uros.described import describe_content, describe_text

        described = describe_text(subject) if isinstance(subject, str) else describe_content(subject)
        return described_input(described.assembly)
    return open_system(as_paths(_paths(subject)))


def paths_of(subject: Subject) -> tuple[Path, ...] | None:
    """The files of a subject; None if it is none."""
    from amalthea_uros.metamodel.model import Model

    if isinstance(subject, System | Model | Mapping) or _is_text(subject):
        return None
    return as_paths(_paths(subject))


def reusable(subject: Subject) -> Subject:
    """The subject, of which paths can be asked for again."""
    return paths_of(subject) or subject


def description_text(subject: Subject) -> tuple[str, Path] | None:
    """The text of a description, and its file; None if the subject is something else."""
    paths = paths_of(subject)
    if paths is not None and len(paths) == 1 and is_description(paths[0]):
        return read_text(paths[0], DESCRIPTION_SIZE), paths[0]
    return (subject, TEXT) if _is_text(subject) else None


def system_of(subject: Subject) -> System:
    """The system of a subject; as `open_subject`."""
    return open_subject(subject).system


def _is_text(subject: object) -> TypeGuard[str]:
    """Whether something is a text, and no path."""
    return isinstance(subject, str) and "\n" in subject


def _paths(subject: object) -> list[StrPath]:
    given = type(subject).__name__
    if isinstance(subject, str | PathLike):
        return [subject]
    if isinstance(subject, Iterable) and not isinstance(subject, bytes | bytearray):
        items = list(subject)
        paths = [item for item in items if isinstance(item, str | PathLike)]
        if len(paths) == len(items):
            return paths
        given = f"a {given} with other objects than paths; taskset() makes a System of tasks"
    raise TypeError(f"expected {_ACCEPTED}; not {given}")
