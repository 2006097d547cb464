"""Keys of sections: marks of their types, and their defaults.

Sections are checked by functions of this package. A library for that takes longer to import, and to build a class per section, than
everything else that a short command does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from amalthea_uros._internal.records import dataclass

#: In place of the default of a key that must be stated.
REQUIRED: Any = object()


@dataclass(frozen=True, slots=True)
class Before:
    """A mark of a type: what converts a value before its type is checked."""

    convert: Callable[[Any], Any]


@dataclass(frozen=True, slots=True)
class After:
    """A mark of a type: what examines a value of the right type."""

    examine: Callable[[Any], Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """A mark of a type: the limits of a number, or of the length of a list or mapping."""

    ge: int | None = None
    gt: int | None = None
    le: int | None = None
    lt: int | None = None
    min_length: int | None = None
    max_length: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Examples:
    """A mark of a type: values that editors propose."""

    values: Sequence[str]


@dataclass(frozen=True, slots=True, eq=False)
class EditorSchema:
    """A mark of a type: its whole JSON schema."""

    schema: Mapping[str, Any]


@dataclass(frozen=True, slots=True, eq=False)
class Meanings:
    """A mark of a choice: what editors say of each word; words with a hyphen are written with an underscore here."""

    by_word: Mapping[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class WrittenAs:
    """A mark of a type: another type, of which values in files are."""

    annotation: Any


@dataclass(frozen=True, slots=True)
class KeyEntry:
    """An entry of a section: a key, beside its type.

    Attributes
    ----------
    alias : how files write it, if not as the attribute is called
    marks : further marks of its type
    """

    default: Any
    default_factory: Callable[[], Any] | None
    alias: str | None
    marks: tuple[Any, ...]


def entry(
    default: Any = REQUIRED,
    *,
    default_factory: Callable[[], Any] | None = None,
    alias: str | None = None,
    examples: Sequence[str] = (),
    min_length: int | None = None,
) -> Any:
    """An entry of a section: a key, beside its type, in the place of its default."""
    lengths = (Limits(min_length=min_length),) if min_length is not None else ()
    return KeyEntry(default, default_factory, alias, (*lengths, *((Examples(examples),) if examples else ())))


F = TypeVar("F", bound=Callable[..., Any])
#: The attribute of methods that examine sections.
EXAMINES = "examines_section"


def examines(method: F) -> F:
    """Have a method examine each section whose keys are right; it raises a `WrongValueError`."""
    setattr(method, EXAMINES, True)
    return method
