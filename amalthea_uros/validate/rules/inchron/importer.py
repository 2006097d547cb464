"""How am2inc reads files: with which metamodel, how it resolves references, and how it reads quantities."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.naming import TYPE_MARK, encode, name_of, segments
from amalthea_uros.metamodel.source import SourceText
from amalthea_uros.metamodel.tags import attributes_of_tag
from amalthea_uros.validate.context import Context

_NEWEST = "3.2.0"


#: The metamodels that are part of am2inc. It uses that of 3.2.0 for all 3.x versions and for unsupported ones.
_METAMODELS = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", _NEWEST)


def metamodel_of(document: Document) -> str:
    """The version of the metamodel with which am2inc reads a file."""
    return document.file_version if document.file_version in _METAMODELS else _NEWEST


def metamodel(element: Element) -> str:
    """The version of the metamodel with which am2inc reads the file of an object."""
    document = element.document
    return _NEWEST if document is None else metamodel_of(document)


def has_unit(quantity: am.Time | am.Frequency | am.DataSize) -> bool:
    """Whether a quantity has a unit; am2inc replaces a quantity without one by a default."""
    return quantity.unit not in (None, "_undefined_")


def amount(quantity: am.Time | am.Frequency | am.DataSize | None) -> float:
    """The value of a quantity in its unit; 0 if it has no unit."""
    return (quantity.value or 0) if quantity is not None and has_unit(quantity) else 0


def tag_of(element: Element) -> tuple[SourceText, Mapping[str, str]] | None:
    """The source of the file of an object, and the attributes of its tag; None if it was not read from a file of its version."""
    document = element.document
    source = document.source if document is not None and document.migrated_from is None else None
    place = source.index.get(element) if source is not None else None
    return (source, attributes_at(source.text, source.starts[place])) if source is not None and place is not None else None


def attributes_at(text: str, start: int = 0) -> dict[str, str]:
    """The attributes of the tag at an offset."""
    return {attribute["name"]: attribute["quoted"][1:-1] for attribute in attributes_of_tag(text, start)}


def has_id(element: Element) -> bool:
    """Whether an object has an `xmi:id` in its file. An object that was not read from a file will be written with one."""
    tag = tag_of(element)
    return tag is None or tag[0].prefixes.xmi_id in tag[1]


def without_namespace(context: Context) -> dict[Element, str]:
    """The members of namespaces that have no `xmi:id`, with the names by which am2inc finds them."""
    members = (member for member in context.all(am.INamespaceMember) if member.namespace is not None and not has_id(member))
    return {member: f"{encode(name_of(member))}{TYPE_MARK}{type(member).__name__}" for member in members}


def has_encoded_name(element: Element) -> bool:
    """Whether references encode characters of a name; am2inc computes names without encoding."""
    return any(segment and segment != encode(segment) for segment in segments(element))
