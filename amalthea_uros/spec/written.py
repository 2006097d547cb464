"""The values of sections as they are written in an `app.yaml`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TypeAlias, get_args, get_origin

from amalthea_uros.spec.section import DescriptionSection, SectionField, Shorthand
from amalthea_uros.spec.values import quantity_text

#: What a file can contain: text as it is read again, numbers, lists and mappings.
Written: TypeAlias = "str | int | Sequence[Written] | Mapping[str, Written]"


def written(section: DescriptionSection, key: str) -> Written | None:
    """The value of a key, also its default; None if there is none."""
    value = getattr(section, key)
    return None if value is None else _written(value, quantity_text(_marks(type(section).model_fields[key])))


def content(section: DescriptionSection) -> dict[str, Written]:
    """The stated keys of a section with their values."""
    values = {key: written(section, key) for key in type(section).model_fields if section.states(key)}
    return {key: value for key, value in values.items() if value is not None}


def is_list(section: DescriptionSection, key: str) -> bool:
    """Whether the value of a key is a list."""
    return any(get_origin(part) is list for part in _parts(type(section).model_fields[key].annotation))


def section_class(section: DescriptionSection, key: str) -> type[DescriptionSection] | None:
    """The kind of section that the value of a key is; None for other values."""
    parts = _parts(type(section).model_fields[key].annotation, into_lists=False)
    return next((each for each in parts if isinstance(each, type) and issubclass(each, DescriptionSection)), None)


def _written(value: Any, text: Callable[[Any], str] | None) -> Written:
    if isinstance(value, DescriptionSection):
        return _plain(value) or content(value)
    if isinstance(value, Mapping):
        return {str(key): _written(item, text) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_written(item, text) for item in value]
    if text is not None:
        return text(value)
    return value if isinstance(value, int | str) else str(value)


def _plain(section: DescriptionSection) -> Written | None:
    """The plain value of a section that says no more than one; None otherwise."""
    parts = content(section)
    if not isinstance(section, Shorthand) or parts.keys() != set(section.shorthand):
        return None
    first, *others = parts.values()
    return first if all(each == first for each in others) else None


def _marks(field: SectionField) -> Iterator[Any]:
    """The marks of the type of a field."""
    yield from field.metadata
    for part in _parts(field.annotation):
        yield from getattr(part, "__metadata__", ())


def _parts(annotation: Any, *, into_lists: bool = True) -> Iterator[Any]:
    """A type and those that it is made of."""
    yield annotation
    if into_lists or get_origin(annotation) not in (list, dict):
        for inner in get_args(annotation):
            yield from _parts(inner, into_lists=into_lists)
