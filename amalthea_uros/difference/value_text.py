"""Short texts of values and objects."""

from __future__ import annotations

from enum import Enum
from typing import Any

from amalthea_uros.difference.names import has_identity
from amalthea_uros.metamodel.classes_common import CustomProperty, ListObject, MapObject, Quantity, ReferenceObject, Value
from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.naming import qualified_name, segments

UNSET = "unset"

#: Longer texts are truncated.
_MAX_LENGTH = 120


def is_inline(element: Element) -> bool:
    """Whether a part is read as a value of its holder: `10 ms`."""
    return isinstance(element, Quantity | Value)


def value_text(value: Any) -> str:
    """A value of a feature: a number, text, literal, an object referred to or a part that is read as a value."""
    if value is None:
        return UNSET
    if isinstance(value, Element):
        return _of_part(value) if is_inline(value) else readable_name(value)
    if isinstance(value, Enum):
        return UNSET if value.value == "_undefined_" else str(value.value)
    if isinstance(value, bool):
        return str(value).lower()
    return shortened(str(value))


def readable_name(element: Element) -> str:
    """The unique name of an object in readable form."""
    if element.is_referable or element.unresolved is not None:
        return ".".join(filter(None, segments(element))) or qualified_name(element)
    return qualified_name(element)


def label(element: Element) -> str:
    """The label of an object: its unique name or else its key, its name, or the object that it refers to."""
    values = element.__dict__
    if has_identity(element):
        return readable_name(element)
    if is_inline(element):
        return value_text(element)
    for name in ("key", "name"):
        if values.get(name):
            return value_text(values[name])
    target = first_reference(element)
    return readable_name(target) if target is not None else ""


def first_reference(element: Element) -> Element | None:
    """The target of the first reference of an object, in the order of its features: mostly what the object is about."""
    found = dict(references_of(element))
    for name in features_of(type(element)):
        if name in found:
            target: Element = found[name][0] if isinstance(found[name], list) else found[name]
            return target
    return None


def shortened(text: str) -> str:
    """A text in one line of limited length."""
    line = " ".join(text.split())
    return line if len(line) <= _MAX_LENGTH else line[: _MAX_LENGTH - 3] + "..."


def _of_part(part: Element) -> str:
    values = part.__dict__
    if isinstance(part, Quantity):
        unit = value_text(values.get("unit"))
        return f"{value_text(values.get('value') or 0)}{'' if unit == UNSET else f' {unit}'}"
    if isinstance(part, ListObject):
        return shortened(f"[{', '.join(map(_of_part, part.values))}]")
    if isinstance(part, MapObject):
        return shortened(f"{{{', '.join(map(_of_entry, part.entries))}}}")
    if isinstance(part, ReferenceObject) and part.value is not None:
        return readable_name(part.value)
    return value_text(values.get("value"))


def _of_entry(entry: CustomProperty) -> str:
    return f"{entry.key}: {value_text(entry.value)}"
