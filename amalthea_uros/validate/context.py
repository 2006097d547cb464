"""What rules may ask of the model, found once for all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TypeVar, cast

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.naming import unique_name

E = TypeVar("E", bound=Element)
T = TypeVar("T")


class Context:
    """A model, with its objects by class."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._once: dict[object, object] = {}

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
        if cls not in self._once:
            self._once[cls] = [element for kind, found in self._by_type.items() if issubclass(kind, cls) for element in found]
        return cast("Sequence[E]", self._once[cls])

    def uses(self, cls: type[Element], feature: str) -> Counter[Element]:
        """How often each object is referred to by a feature of objects of a class."""
        key = (cls, feature)
        if key not in self._once:
            self._once[key] = Counter(getattr(element, feature) for element in self.all(cls))
        return cast("Counter[Element]", self._once[key])

    def once(self, function: Callable[[Context], T]) -> T:
        """What a function of a rule finds out about the whole model."""
        if function not in self._once:
            self._once[function] = function(self)
        return cast("T", self._once[function])
