"""Fields of results: a table for each class, and the one function that makes JSON of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from pathlib import PurePath
from typing import Any, TypeAlias

from amalthea_uros.diagnostics import Finding

#: Where the value of a field comes from: attributes and keys joined with dots, of which any may be None; or a function.
Source: TypeAlias = str | Callable[[Any], Any]
#: A name whose attribute is called the same, without the unit `_ps`; or a name with its source. The fields that a function gives
#: with their names are added in the place of `ALSO`.
Field: TypeAlias = str | tuple[str, Source]

#: The place of a function that gives a mapping of fields.
ALSO = "*"
#: The value of a field that the object does not have.
ABSENT = object()
#: The end of the names of times, which are whole picoseconds.
TIME_SUFFIX = "_ps"


class JsonFields(dict[str, Any]):
    """Fields whose values are JSON already, so that nothing is left to be done where they are a part of other ones."""


#: Most values are of these types, and are in JSON what they are.
_PLAIN = frozenset({type(None), str, int, bool, JsonFields})

_FIELDS: dict[type, tuple[Field, ...]] = {}


def declare(kind: type, *fields: Field) -> None:
    """Say which fields a class has for programs, in their order."""
    _FIELDS[kind] = fields


def declared() -> Mapping[type, tuple[Field, ...]]:
    """The classes that have been declared, with their fields."""
    return _FIELDS


def is_declared(kind: type) -> bool:
    """Whether a class has fields for programs."""
    return kind in _FIELDS


def json_of(value: Any, name: str = "") -> Any:
    """A value for JSON: objects by the fields of their class, fractions as numbers.

    Parameters
    ----------
    name : of the field; times are rounded to whole picoseconds

    Raises
    ------
    TypeError : nobody declared the class of an object.
    """
    kind = type(value)
    if kind in _PLAIN:
        return value
    if kind in _FIELDS:
        return record(value, _FIELDS[kind])
    match value:
        case str() | int():
            return value
        case Fraction() | float():
            return round(value) if name.endswith(TIME_SUFFIX) else float(value)
        case PurePath():
            return str(value)
        case Mapping():
            return {key: json_of(each, name) for key, each in value.items()}
        case Iterable():
            return [each if type(each) in _PLAIN else json_of(each, name) for each in value]
    raise TypeError(f"{type(value).__name__} has no fields")


def record(value: Any, fields: Iterable[Field]) -> JsonFields:
    """Some fields of an object, whether its class is declared or not."""
    found = JsonFields()
    for field in fields:
        name, source = (field, field.removesuffix(TIME_SUFFIX)) if isinstance(field, str) else field
        part = value_at(value, source)
        if name == ALSO:
            found |= fields_of(part)
        elif part is not ABSENT:
            found[name] = part if type(part) in _PLAIN else json_of(part, name)
    return found


def fields_of(values: Mapping[str, Any]) -> JsonFields:
    """Fields that are computed with their names; unlike the keys of other mappings, which may be names of objects, these have units."""
    return JsonFields((name, value if type(value) in _PLAIN else json_of(value, name)) for name, value in values.items())


def value_at(value: Any, source: Source) -> Any:
    """The value of a source; None if an object on the path is."""
    if not isinstance(source, str):
        return source(value)
    for step in source.split("."):
        if value is None:
            return None
        # To ask whether an object is a mapping takes as long as everything else here.
        is_mapping = type(value) not in _FIELDS and isinstance(value, Mapping)
        value = value.get(step) if is_mapping else getattr(value, step)
    return value


def group(*fields: Field) -> Callable[[Any], dict[str, Any]]:
    """A source of several fields of the same object, as one."""
    return lambda value: record(value, fields)


def list_of(source: Source, *fields: Field) -> Callable[[Any], list[dict[str, Any]]]:
    """A source of a list: the same fields of each of several objects."""
    return lambda value: [record(part, fields) for part in value_at(value, source)]


def given(source: str) -> Callable[[Any], Any]:
    """A source of a field that is left out where it is None."""

    def read(value: Any) -> Any:
        found = value_at(value, source)
        return ABSENT if found is None else found

    return read


declare(
    Finding,
    *("rule", "severity", "effect", "message", "help"),
    ("file", "location.path"),
    ("line", "location.line"),
    ("column", "location.column"),
    "object",
)
