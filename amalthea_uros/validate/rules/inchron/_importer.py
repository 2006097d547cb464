"""The metamodels with which am2inc reads files, and how it reads quantities."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import DataSize, Frequency, Time
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document

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


def has_unit(quantity: Time | Frequency | DataSize) -> bool:
    """Whether a quantity has a unit; am2inc replaces a quantity without one by a default."""
    return quantity.unit not in (None, "_undefined_")


def amount(quantity: Time | Frequency | DataSize | None) -> float:
    """The value of a quantity in its unit; 0 if it has no unit."""
    return (quantity.value or 0) if quantity is not None and has_unit(quantity) else 0
