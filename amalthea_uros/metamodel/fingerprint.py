"""What an object says, as a value that can be compared: equal fingerprints mean equal content."""

from __future__ import annotations

from operator import itemgetter
from typing import Any

from amalthea_uros.metamodel.defaults import defaults_of
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.naming import unique_name


class Fingerprints:
    """Fingerprints of the objects of one model, each made once."""

    def __init__(self, version: str, renamed: dict[str, str]) -> None:
        self._version = version
        self._made: dict[Element, int] = {}
        #: Unique names that count as another one, because the object was renamed.
        self._renamed = renamed

    def of(self, element: Element) -> int:
        """Hash of everything that an object says, with its parts."""
        made = self._made.get(element)
        if made is None:
            made = self._made[element] = hash((type(element).__name__, *self._values(element, with_name=True)))
        return made

    def without_name(self, element: Element) -> int:
        """The same, whatever the name of the object."""
        return hash((type(element).__name__, *self._values(element, with_name=False)))

    def target(self, element: Element) -> str:
        """What a reference says: the unique name of its target, after renaming."""
        name = unique_name(element)
        return self._renamed.get(name, name)

    def attributes(self, element: Element) -> dict[str, Any]:
        """Every attribute that says something, set or by default."""
        cls = type(element)
        values = element.__dict__
        found = dict(defaults_of(self._version, cls))
        for name, feature in features_of(cls).items():
            if feature.kind == "attribute" and values.get(name) is not None:
                found[name] = values[name]
        return found

    def _values(self, element: Element, with_name: bool) -> list[Any]:
        found: list[Any] = [item for item in self.attributes(element).items() if with_name or item[0] != "name"]
        for name, value in element.__dict__.items():
            if name == "_extras":
                found.append((name, *sorted(value.attributes.items()), *(raw for _, raw in value.content)))
                continue
            feature = features_of(type(element))[name]
            if feature.kind != "attribute" and value:
                values = value if isinstance(value, list) else [value]
                found.append((name, *(self.of(v) if feature.contains(v) else self.target(v) for v in values)))
        return sorted(found, key=itemgetter(0))
