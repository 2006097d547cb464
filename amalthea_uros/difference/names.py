"""Tokens that represent objects when two models are compared: objects with the same token are the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from amalthea_uros.metamodel.classes_sw import CallArgument, RunnableCall
from amalthea_uros.metamodel.element import references_of
from amalthea_uros.metamodel.naming import TYPE_MARK, segments

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
