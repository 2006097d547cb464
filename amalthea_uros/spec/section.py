"""Base of all sections of an `app.yaml`: their keys are known, and they know their locations."""

from __future__ import annotations

from typing import Any, ClassVar

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler, GetJsonSchemaHandler, PrivateAttr, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from amalthea_uros.diagnostics import Location
from amalthea_uros.spec.nodes import MappingNode, Node, SequenceNode, YamlText
from amalthea_uros.spec.validators import require_values

#: How keys begin that are for other tools, or for anchors; they are ignored.
EXTENSION = "x-"


class DescriptionSection(BaseModel):
    """A mapping of the file."""

    # Only the sections that something is validated by are built, with those in them, when that happens first; but at once those of
    # which descriptions, platforms and operating systems consist, which would build them once each.
    model_config = ConfigDict(extra="forbid", frozen=True, protected_namespaces=(), defer_build=True)

    _where: tuple[MappingNode, YamlText] | None = PrivateAttr(None)
    #: The section that gives the keys that this one does not state; see `spec.merging`.
    _base: DescriptionSection | None = PrivateAttr(None)

    @model_validator(mode="before")
    @classmethod
    def _without_extensions(cls, value: Any) -> Any:
        if not isinstance(value, dict):
            return value
        return {key: item for key, item in value.items() if not key.startswith(EXTENSION)}

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        schema = handler(source)
        require_values(handler.resolve_ref_schema(schema))
        return schema

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        from amalthea_uros.spec.docstrings import field_docstrings

        reference = handler(core_schema)
        properties = handler.resolve_ref_schema(reference)["properties"]
        for key, text in field_docstrings(cls).items():
            properties[key].setdefault("description", text)
        return reference

    def location(self, key: str | None = None, index: int | None = None) -> Location | None:
        """Location of the section, of the value of a key, or of an item of that value; None if it was not read from a file.

        A key that is not given has the location of the section; one that a platform gives has its location there.
        """
        where = self._where
        if key is not None and self._base is not None and (where is None or key not in where[0].items):
            inherited = self._base.location(key, index)
            if inherited is not None and self._base.states(key):
                return inherited
        if where is None:
            return None
        own, source = where
        node: Node = own
        if key is not None and key in own.items:
            node = own.items[key]
            if index is not None and isinstance(node, SequenceNode):
                node = node.items[index]
        return source.location(node.place)

    def move_to(self, other: DescriptionSection, key: str) -> None:
        """Give the section and those in it the location of a key of another one, which names the file that they are from."""
        if other._where is not None:
            own, source = other._where
            attach_locations(self, MappingNode(own.items.get(key, own).place, {}, {}), source)

    def states(self, key: str) -> bool:
        """Whether the author wrote the key, or that of the platform."""
        return key in self.model_fields_set

    def inherits(self, key: str) -> bool:
        """Whether the key is stated, but not in the text of the section: a known platform states it."""
        return self.states(key) and self._where is not None and key not in self._where[0].items


class Shorthand(DescriptionSection):
    """A section that may be written as a plain value.

    Attributes
    ----------
    shorthand : the keys that get the plain value
    plain_value : what the plain value means
    nested : the section of that value, if it may be a mapping itself
    """

    shorthand: ClassVar[tuple[str, ...]]
    plain_value: ClassVar[str]
    nested: ClassVar[type[DescriptionSection] | None] = None

    @model_validator(mode="before")
    @classmethod
    def _of_plain_value(cls, value: Any) -> Any:
        if isinstance(value, DescriptionSection) or (isinstance(value, dict) and not cls._is_nested(value)):
            return value
        return dict.fromkeys(cls.shorthand, value)

    @classmethod
    def _is_nested(cls, value: dict[str, Any]) -> bool:
        if cls.nested is None or not cls.model_fields.keys().isdisjoint(value):
            return False
        return not cls.nested.model_fields.keys().isdisjoint(value)

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        reference = super().__get_pydantic_json_schema__(core_schema, handler)
        schema = handler.resolve_ref_schema(reference)
        if "anyOf" not in schema:
            whole = dict(schema)
            schema.clear()
            plain = whole["properties"][cls.shorthand[0]] | {"description": cls.plain_value}
            schema.update(anyOf=[plain, whole], description=whole["description"])
        return reference


def attach_locations(value: Any, node: Node, source: YamlText) -> None:
    """Attach their locations to a section and everything in it."""
    if isinstance(value, DescriptionSection) and isinstance(node, MappingNode):
        value._where = node, source
        # A section that is not given, or given as a shorthand, has the location of the outer one; in a shorthand also its keys.
        outer = node if isinstance(value, Shorthand) else MappingNode(node.place, {}, {})
        for name, field in type(value).model_fields.items():
            inner = node.items.get(field.alias or name, outer)
            if inner is not outer or isinstance(getattr(value, name), DescriptionSection):
                attach_locations(getattr(value, name), inner, source)
    elif isinstance(value, DescriptionSection):
        is_list = isinstance(value, Shorthand) and isinstance(node, SequenceNode)
        items = dict.fromkeys(value.shorthand, node) if is_list and isinstance(value, Shorthand) else {}
        attach_locations(value, MappingNode(node.place, items, {}), source)
    elif isinstance(value, list | tuple) and isinstance(node, SequenceNode):
        for item, inner in zip(value, node.items, strict=True):
            attach_locations(item, inner, source)
    elif isinstance(value, dict) and isinstance(node, MappingNode):
        for key, item in value.items():
            attach_locations(item, node.items[key], source)
