"""What rules may ask of the model, found once for all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TypeVar, cast

from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.model import Document, Model
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
    def _only_version(self) -> str | None:
        versions = {document.facts_version for document in self.model.documents}
        return versions.pop() if len(versions) == 1 else None

    def version_of(self, element: Element) -> str:
        """The AMALTHEA version whose facts hold for an object."""
        return self._only_version or cast("Document", element.document).facts_version

    @cached_property
    def names_in_files(self) -> Counter[tuple[Document, str]]:
        """How often each name occurs in a file."""
        return Counter(
            (document, unique_name(element))
            for document in self.model.documents
            for element in document.root.walk()
            if element.is_referable
        )

    @cached_property
    def names(self) -> Counter[str]:
        """How often each name occurs by which objects are referred to."""
        return Counter(unique_name(element) for element in self.model.walk() if element.is_referable)

    @cached_property
    def referred(self) -> frozenset[Element]:
        """The objects to which some other refers."""
        values = (value for element in self.model.walk() for _, value in references_of(element))
        return frozenset(target for value in values for target in (value if isinstance(value, list) else (value,)))

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
