"""JSON schemas of sections, for editors and for advice about keys."""

from __future__ import annotations

import inspect
import types
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, TypeAlias, Union, get_args, get_origin

from amalthea_uros.spec.docstrings import field_docstrings
from amalthea_uros.spec.fields import EditorSchema, Examples, Limits, Meanings, WrittenAs
from amalthea_uros.spec.section import DescriptionSection, Shorthand

Schema: TypeAlias = dict[str, Any]
#: The limits of numbers, lists and mappings in JSON schemas.
_OF_NUMBERS = {"ge": "minimum", "gt": "exclusiveMinimum", "le": "maximum", "lt": "exclusiveMaximum"}
_OF_LENGTHS = {"array": "Items", "object": "Properties"}
_NOTHING: Mapping[str, Any] = {"type": "null"}
_TYPES = {int: "integer", float: "number", str: "string", bool: "boolean"}


def whole_schema(kind: type[DescriptionSection], reference: str = "#/$defs/{name}") -> Schema:
    """The schema of a section.

    Parameters
    ----------
    reference : how one refers to the definition of a section, with `{name}`
    """
    definitions = _SectionSchemas(reference)
    whole = definitions.section(kind)
    return whole | {"$defs": dict(sorted(definitions.result.items()))}


class _SectionSchemas:
    """The schemas of the sections in a section.

    Attributes
    ----------
    result : by the names of their classes
    """

    def __init__(self, reference: str) -> None:
        self._reference = reference
        self.result: dict[str, Schema] = {}

    def section(self, kind: type[DescriptionSection]) -> Schema:
        """The schema of a section itself."""
        texts = field_docstrings(kind)
        properties: dict[str, Schema] = {}
        for field in kind.model_fields.values():
            schema = self._typed(field.annotation, field.metadata)
            if not field.is_required and field.default_factory is None:
                schema["default"] = field.default
            if field.key in texts:
                schema.setdefault("description", texts[field.key])
            properties[field.key] = schema
        required = [field.key for field in kind.model_fields.values() if field.is_required]
        result: Schema = {"additionalProperties": False, "description": inspect.getdoc(kind), "properties": properties}
        for stated, implied in kind.implied_keys().items():
            required = [key for key in required if key not in implied]
            result["allOf"] = [{"anyOf": [{"required": [stated]}, {"required": list(implied)}]}]
        result |= {"required": required} if required else {}
        result["type"] = "object"
        if not issubclass(kind, Shorthand):
            return result
        plain = properties[kind.shorthand[0]] | {"description": kind.plain_value}
        return {"anyOf": [plain, result], "description": result["description"]}

    def _typed(self, annotation: Any, marks: Sequence[Any] = ()) -> Schema:
        """The schema of a type with further marks."""
        schema = self._of_type(annotation)
        for mark in marks:
            schema = self._marked(schema, mark)
        return schema

    def _of_type(self, annotation: Any) -> Schema:
        origin, parts = get_origin(annotation), get_args(annotation)
        if origin is Annotated:
            return self._typed(parts[0], parts[1:])
        if origin is Literal:
            words: Schema = {"const": parts[0]} if len(parts) == 1 else {"enum": list(parts)}
            return words | {"type": _TYPES[type(parts[0])]}
        if origin is list:
            return {"items": self._typed(parts[0]), "type": "array"}
        if origin is dict:
            return {"patternProperties": {self._typed(parts[0])["pattern"]: self._typed(parts[1])}, "type": "object"}
        if origin in (Union, types.UnionType):
            return {"anyOf": [dict(_NOTHING) if each is type(None) else self._typed(each) for each in parts]}
        if isinstance(annotation, type) and issubclass(annotation, DescriptionSection):
            return self._referred(annotation)
        return {"type": _TYPES[annotation]} if annotation in _TYPES else {}

    def _referred(self, kind: type[DescriptionSection]) -> Schema:
        name = kind.__name__
        if name not in self.result:
            # Before its own schema, which may refer to it.
            self.result[name] = {}
            self.result[name] = self.section(kind)
        return {"$ref": self._reference.format(name=name)}

    def _marked(self, schema: Schema, mark: Any) -> Schema:
        match mark:
            case EditorSchema(own):
                return dict(own)
            case WrittenAs(annotation):
                return self._typed(annotation)
            case Examples(values):
                return schema | {"examples": list(values)}
            case Meanings(by_word):
                return schema | {"markdownEnumDescriptions": [by_word[word.replace("-", "_")] for word in schema["enum"]]}
            case Limits():
                return _limited(schema, mark)
        return schema


def _limited(schema: Schema, limits: Limits) -> Schema:
    if "anyOf" in schema:
        return schema | {"anyOf": [each if each == _NOTHING else _limited(each, limits) for each in schema["anyOf"]]}
    numbers = {word: getattr(limits, name) for name, word in _OF_NUMBERS.items()}
    things = _OF_LENGTHS.get(str(schema.get("type")), "")
    lengths = {f"min{things}": limits.min_length, f"max{things}": limits.max_length}
    return schema | {word: value for word, value in (numbers | lengths).items() if value is not None}
