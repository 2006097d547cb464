"""Tokens that represent objects when two models are compared, and short texts of values and objects."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any

from amalthea_uros.metamodel.classes_common import CustomProperty, ListObject, MapObject, Quantity, ReferenceObject, Value
from amalthea_uros.metamodel.classes_sw import CallArgument, RunnableCall
from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.naming import TYPE_MARK, qualified_name, segments

if TYPE_CHECKING:
    from collections.abc import Collection

    from amalthea_uros.metamodel.element import Element
    from amalthea_uros.metamodel.model import Model

Token = tuple[Any, ...]


def has_identity(element: Element) -> bool:
    """Whether an object is identified by its unique name, regardless of its position.

    Call arguments are not: they belong to their call, of which there may be several with the same names.
    """
    return element.is_referable and type(element) is not CallArgument


class ElementNames:
    """The objects of one model by token.

    Attributes
    ----------
    order : the place of each object in the walk through the model
    by_token : the objects with an identity, several where names are not unique
    translation : tokens of renamed objects -> those that the objects have in the other model
    """

    def __init__(self, model: Model) -> None:
        self.order: dict[Element, int] = {}
        self.by_token: dict[Token, list[Element]] = {}
        self.translation: dict[Token, Token] = {}
        self._tokens: dict[Element, Token] = {}
        for place, element in enumerate(model.walk()):
            self.order[element] = place
            if has_identity(element):
                self.by_token.setdefault(self.own_token(element), []).append(element)

    def own_token(self, element: Element) -> Token:
        """Class and qualified name, as they are in this model."""
        token = self._tokens.get(element)
        if token is None:
            token = self._tokens[element] = (_class_name(element), *segments(element))
        return token

    def token(self, element: Element) -> Token:
        """The token that represents an object in comparisons."""
        if type(element) is CallArgument and element.unresolved is None:
            return self._argument_token(element)
        token = self.own_token(element)
        return self.translation.get(token, token)

    def owner(self, element: Element) -> Token:
        """The token of the nearest container with an identity, empty if there is none: files and sub-models are no owners."""
        holder = self._identified(element.container) if element.container is not None else None
        return self.token(holder) if holder is not None else ()

    def neighbours(self, elements: Collection[Element]) -> dict[Element, list[tuple[tuple[str, str], Element]]]:
        """The objects with an identity that refer to some objects, and those to which these refer, each with direction and feature."""
        found: dict[Element, list[tuple[tuple[str, str], Element]]] = {element: [] for element in elements}
        for holder in self.order:
            user: Element | None = None
            for name, value in references_of(holder):
                user = user or self._identified(holder)
                for target in value if isinstance(value, list) else (value,):
                    if user is not None and target in found:
                        found[target].append((("from", name), user))
                    if user in found:
                        found[user].append((("to", name), target))
        return found

    def _identified(self, element: Element) -> Element | None:
        """The object itself or its nearest container with an identity."""
        holder: Element | None = element
        while holder is not None and not has_identity(holder):
            holder = holder.container
        return holder

    def _argument_token(self, argument: CallArgument) -> Token:
        call = argument.container
        called = call.runnable if isinstance(call, RunnableCall) else None
        involved = (called, argument.parameter)
        return (
            "CallArgument",
            argument.name,
            self.owner(argument),
            *(self.token(e) if e is not None else () for e in involved),
        )


def _class_name(element: Element) -> str:
    if element.unresolved is not None and TYPE_MARK in element.unresolved:
        return element.unresolved.rpartition(TYPE_MARK)[2]
    return type(element).__name__


# Short texts of values and objects

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
