"""What rules may ask of the model, found once for all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import cached_property
from typing import TypeVar

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.naming import unique_name

E = TypeVar("E", bound=Element)


class Context:
    """A model, with its objects by class."""

    def __init__(self, model: Model) -> None:
        self.model = model

    @cached_property
    def _by_type(self) -> dict[type[Element], list[Element]]:
        found: dict[type[Element], list[Element]] = {}
        for element in self.model.walk():
            found.setdefault(type(element), []).append(element)
        return found

    @cached_property
    def names(self) -> Counter[str]:
        """How often each name occurs by which objects are referred to."""
        return Counter(unique_name(element) for element in self.model.walk() if element.is_referable)

    def all(self, cls: type[E]) -> Sequence[E]:
        """All objects of a class and its subclasses."""
        return [element for kind, elements in self._by_type.items() if issubclass(kind, cls) for element in elements]  # type: ignore[misc]
