"""The model in the making."""

from __future__ import annotations

from contextlib import contextmanager
from random import Random
from typing import TYPE_CHECKING

from amalthea_uros.metamodel.versions import facts
from synthesis.objects import Object, Value

if TYPE_CHECKING:
    from collections.abc import Iterator


class Plan:
    """Makes the objects of a model and puts them into sub-models.

    Attributes
    ----------
    count : objects made so far, which is the number of elements in the files
    document : number of the file that holds the objects made next
    roots : the root object of each file
    """

    def __init__(self, version: str, seed: int, files: int) -> None:
        self.facts = facts(version)
        self.random = Random(seed)
        self.count = 0
        self.document = 0
        self.roots: list[Object] = []
        self._submodels: dict[tuple[int, str], Object] = {}
        for number in range(files):
            self.document = number
            self.roots.append(self.new("Amalthea"))

    @contextmanager
    def at(self, document: int) -> Iterator[None]:
        """Makes `document` the file at hand for a while."""
        here, self.document = self.document, document
        yield
        self.document = here

    def new(self, cls: str, *owners: Object, **values: Value) -> Object:
        """An object; `owners` are those whose names stand before its own in its unique name."""
        self.count += 1
        return Object(cls, self.document, [owner.name for owner in owners], values)

    def place(self, submodel: str, feature: str, *children: Object) -> None:
        """Appends to a list of a sub-model in the file at hand."""
        key = (self.document, submodel)
        if key not in self._submodels:
            self._submodels[key] = self.new(self._type("Amalthea", submodel))
            self.roots[self.document].values[submodel] = self._submodels[key]
        self._submodels[key].add(feature, *children)

    def _type(self, cls: str, feature: str) -> str:
        return next(fact.type for fact in self.facts.features(cls) if fact.name == feature)

    def time(self, value: int, unit: str) -> Object:
        return self.new("Time", value=value, unit=unit)

    def size(self, value: int, unit: str) -> Object:
        return self.new("DataSize", value=value, unit=unit)

    def constant(self, value: int) -> Object:
        return self.new("DiscreteValueConstant", value=value)

    def custom_property(self, key: str, cls: str, value: Value) -> Object:
        return self.new("CustomProperty", key=key, value=self.new(cls, value=value))


def title(kind: str, number: int) -> str:
    """A name of which every fifteenth needs encoding in ids."""
    if number % 29 == 7:
        return f"{kind} {number} (left/right)"
    if number % 31 == 5:
        return f"{kind}_{number}: Größe & <Lage>"
    return f"{kind}_{number}"
