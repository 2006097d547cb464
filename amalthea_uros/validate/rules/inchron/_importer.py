"""With which of its metamodels am2inc reads a file, and what it makes of quantities."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import DataSize, Frequency, Time
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document

_NEWEST = "3.2.0"

#: The metamodels that are part of am2inc. That of 3.2.0 serves for all of 3.x, and for every version that it does not know.
_METAMODELS = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", _NEWEST)


def metamodel_of(document: Document) -> str:
    """The version of the metamodel with which a file is read."""
    return document.version if document.version in _METAMODELS else _NEWEST


def metamodel(element: Element) -> str:
    """The version of the metamodel with which the file of an object is read."""
    document = element.document
    return _NEWEST if document is None else metamodel_of(document)


def has_unit(quantity: Time | Frequency | DataSize) -> bool:
    """Whether a quantity is read at all; without a unit am2inc takes a default of its own."""
    return quantity.unit not in (None, "_undefined_")


def amount(quantity: Time | Frequency | DataSize | None) -> float:
    """The value of a quantity in its unit; 0 without one."""
    return (quantity.value or 0) if quantity is not None and has_unit(quantity) else 0
