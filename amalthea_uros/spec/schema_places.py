"""The JSON Schema of a section at a place in it: the keys that may be there, what they mean, and the words that are values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import takewhile
from typing import Any, TypeAlias

from amalthea_uros.spec.section import DescriptionSection

Schema: TypeAlias = Mapping[str, Any]
#: Keys, and positions in lists.
Path: TypeAlias = Sequence[int | str]


@cache
def schema_of(kind: type[DescriptionSection]) -> dict[str, Any]:
    """The schema of a section, with definitions."""
    from amalthea_uros.spec.section_schemas import whole_schema

    return whole_schema(kind)


def variants(schema: Schema, whole: Schema) -> Iterator[Schema]:
    """A schema and its alternatives, without references."""
    if "$ref" in schema:
        yield from variants(whole["$defs"][schema["$ref"].rpartition("/")[2]], whole)
        return
    yield schema
    for inner in (*schema.get("anyOf", ()), *schema.get("allOf", ())):
        yield from variants(inner, whole)


def inner_schemas(schema: Schema, part: int | str, whole: Schema) -> Iterator[Schema]:
    """The schemas of the value of a key, or of an item of a list."""
    for variant in variants(schema, whole):
        if isinstance(part, int):
            yield from filter(None, [variant.get("items")])
        else:
            inner = variant.get("properties", {}).get(part)
            by_name = next(iter(variant.get("patternProperties", {}).values()), None)
            yield from filter(None, [inner or by_name])


def schemas_at(path: Path, kind: type[DescriptionSection]) -> list[Schema]:
    """The schemas of the value at a place; none if there is no such place."""
    whole = schema_of(kind)
    level: list[Schema] = [whole]
    for part in path:
        level = [inner for one in level for inner in inner_schemas(one, part, whole)]
    return level


def keys_at(path: Path, kind: type[DescriptionSection]) -> dict[str, Schema]:
    """The keys of the mapping at a place, with the schemas of their values and what they mean."""
    whole = schema_of(kind)
    every = (variant for one in schemas_at(path, kind) for variant in variants(one, whole))
    return {key: _described(value, whole) for variant in every for key, value in variant.get("properties", {}).items()}


def key_at(path: Path, key: str, kind: type[DescriptionSection]) -> Schema | None:
    """The schema of the value of a key, also of a name that the author gives to an item; None if there is no such key."""
    return next((_described(value, schema_of(kind)) for value in schemas_at((*path, key), kind)), None)


def _described(schema: Schema, whole: Schema) -> Schema:
    """A schema that says what the value means, by what it refers to if it does not say so itself."""
    meaning = next((each["description"] for each in variants(schema, whole) if "description" in each), None)
    return schema if meaning is None else {"description": meaning, **schema}


def words_at(path: Path, kind: type[DescriptionSection]) -> list[str]:
    """The words that may be the value at a place: all of them, or examples."""
    whole = schema_of(kind)
    every = [variant for one in schemas_at(path, kind) for variant in variants(one, whole)]
    fixed = [word for variant in every for word in (*variant.get("enum", ()), *filter(None, [variant.get("const")]))]
    booleans = ["true", "false"] if any(variant.get("type") == "boolean" for variant in every) else []
    examples = [word for variant in every for word in variant.get("examples", ())]
    return list(dict.fromkeys(str(word) for word in (*fixed, *booleans, *examples)))


#: Sections inside of each other, at most; the schema has no deeper ones that users write.
_DEEPEST = 6
_PARTS = ("controllers",)


@cache
def places_of_keys(kind: type[DescriptionSection]) -> Mapping[str, Sequence[tuple[str, ...]]]:
    """The mappings that may have each key, by the keys that lead to them; lists are left out."""
    whole = schema_of(kind)
    places: dict[str, dict[tuple[str, ...], None]] = {}

    def add(schema: Schema, path: tuple[str, ...]) -> None:
        for variant in variants(schema, whole):
            for name, inner in variant.get("properties", {}).items():
                places.setdefault(name, {})[path] = None
                if len(path) < _DEEPEST:
                    add(inner, (*path, name))
            if "items" in variant:
                add(variant["items"], path)

    add(whole, ())
    return {key: tuple(paths) for key, paths in places.items()}


def nearest_places(key: str, path: Path, kind: type[DescriptionSection]) -> list[tuple[str, ...]]:
    """The mappings that may have a key and are nearest to another one, in which it is: those with most of its path.

    A key that is only in other parts of the description must be unique to say anything.
    """
    here = tuple(part for part in path if isinstance(part, str))
    # A controller of a robot has the keys of a whole description.
    is_inside = here[:1] == _PARTS
    others = [each for each in places_of_keys(kind).get(key, ()) if each != here and (is_inside or each[:1] != _PARTS)]
    if not others:
        return []
    most = max(_common(each, here) for each in others)
    nearest = [each for each in others if _common(each, here) == most]
    shortest = min(map(len, nearest))
    return [each for each in nearest if len(each) == shortest] if most or len(others) == 1 else []


def _common(one: Sequence[str], other: Sequence[str]) -> int:
    """The number of parts with which both begin."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))
