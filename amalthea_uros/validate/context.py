"""Facts about a model that rules share, computed once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import TypeVar, cast

from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.features import features_of
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
    def versions(self) -> frozenset[str]:
        """The AMALTHEA versions of the facts for the files."""
        return frozenset(document.facts_version for document in self.model.documents)

    @cached_property
    def _only_version(self) -> str | None:
        return next(iter(self.versions)) if len(self.versions) == 1 else None

    def version_of(self, element: Element) -> str:
        """The AMALTHEA version of the facts for an object."""
        return self._only_version or self.document_of(element).facts_version

    def document_of(self, element: Element) -> Document:
        """The file that contains an object."""
        documents = self.model.documents
        return documents[0] if len(documents) == 1 else cast("Document", element.document)

    @cached_property
    def dangling(self) -> dict[Element, list[tuple[str, str]]]:
        """The unresolved references: by object, the XML name of the feature and the text of the reference."""
        found: dict[Element, list[tuple[str, str]]] = {}
        for cls, holders in self._by_type.items():
            for holder in holders:
                for name, value in references_of(holder):
                    for target in value if isinstance(value, list) else (value,):
                        if target.unresolved is not None:
                            found.setdefault(holder, []).append((features_of(cls)[name].xml_name, target.unresolved))
        return found

    @cached_property
    def namesakes(self) -> dict[Element, list[Element]]:
        """The objects that share their name with others of their class, each with all objects of this name."""
        by_name: dict[str, list[Element]] = {}
        for kind, found in self._by_type.items():
            if kind.is_referable:
                for element in found:
                    by_name.setdefault(unique_name(element), []).append(element)
        return {element: same for same in by_name.values() if len(same) > 1 for element in same}

    @cached_property
    def referred(self) -> frozenset[Element]:
        """The objects that are the target of a reference."""
        values = (value for element in self.model.walk() for _, value in references_of(element))
        return frozenset(target for value in values for target in (value if isinstance(value, list) else (value,)))

    def all(self, cls: type[E]) -> Sequence[E]:
        """All objects of a class and its subclasses."""
        if cls not in self._once:
            self._once[cls] = [element for kind, found in self._by_type.items() if issubclass(kind, cls) for element in found]
        return cast("Sequence[E]", self._once[cls])

    def by_class(self, cls: type[Element] | tuple[type[Element], ...]) -> Iterator[tuple[type[Element], Sequence[Element]]]:
        """The objects of one or several classes and their subclasses, grouped by their own class."""
        return ((kind, found) for kind, found in self._by_type.items() if issubclass(kind, cls))

    def uses(self, cls: type[Element], feature: str) -> Counter[Element]:
        """The number of references to each object by a feature of the objects of a class."""
        key = (cls, feature)
        if key not in self._once:
            self._once[key] = Counter(getattr(element, feature) for element in self.all(cls))
        return cast("Counter[Element]", self._once[key])

    def once(self, function: Callable[[Context], T]) -> T:
        """The result of a function of the whole model, computed once."""
        if function not in self._once:
            self._once[function] = function(self)
        return cast("T", self._once[function])
