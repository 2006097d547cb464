"""How objects are written in their files."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.source import Source, attributes_of_tag


def tag_of(element: Element) -> tuple[Source, Mapping[str, str]] | None:
    """The source of the file of an object, and the attributes of its tag; None if it was not read from a file of its version."""
    document = element.document
    source = document.source if document is not None and document.migrated_from is None else None
    place = source.index.get(element) if source is not None else None
    return (source, attributes_at(source.text, source.start(place))) if source is not None and place is not None else None


def attributes_at(text: str, start: int = 0) -> dict[str, str]:
    """The attributes of the tag at an offset."""
    return {attribute["name"]: attribute["quoted"][1:-1] for attribute in attributes_of_tag(text, start)}
