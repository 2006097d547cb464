"""The JSON Schema of a section at a place in it: the keys that may be there, what they mean, and the words that are values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any, TypeAlias

from amalthea_uros.spec.section import DescriptionSection

Schema: TypeAlias = Mapping[str, Any]
#: Keys, and positions in lists.
Path: TypeAlias = Sequence[int | str]


@cache
def schema_of(kind: type[DescriptionSection]) -> dict[str, Any]:
    """The schema of a section, as pydantic writes it."""
    return kind.model_json_schema(by_alias=True)


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
    """The keys of the mapping at a place, with the schemas of their values."""
    whole = schema_of(kind)
    every = (variant for one in schemas_at(path, kind) for variant in variants(one, whole))
    return {key: value for variant in every for key, value in variant.get("properties", {}).items()}


def words_at(path: Path, kind: type[DescriptionSection]) -> list[str]:
    """The words that may be the value at a place: all of them, or examples."""
    whole = schema_of(kind)
    every = [variant for one in schemas_at(path, kind) for variant in variants(one, whole)]
    fixed = [word for variant in every for word in (*variant.get("enum", ()), *filter(None, [variant.get("const")]))]
    booleans = ["true", "false"] if any(variant.get("type") == "boolean" for variant in every) else []
    examples = [word for variant in every for word in variant.get("examples", ())]
    return list(dict.fromkeys(str(word) for word in (*fixed, *booleans, *examples)))
