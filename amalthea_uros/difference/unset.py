"""The meaning of unset attributes when documents of one or several AMALTHEA versions are compared."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from amalthea_uros.metamodel.defaults import default_value
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import facts

if TYPE_CHECKING:
    from collections.abc import Iterable

    from amalthea_uros.metamodel.model import Document

#: Equal to no value.
_VARIES = object()


class UnsetAttribute(NamedTuple):
    """An unset attribute in one version.

    Attributes
    ----------
    default : the value that means the same as being unset
    stands_for : the value that unset means; None if one of the versions has no such attribute, so that there is no difference
    common : the value that unset means in all versions; equal to no value if it differs between them
    """

    default: Any
    stands_for: Any
    common: Any

    def meaning(self, value: Any) -> Any:
        """A value of the attribute as it is compared."""
        return self.stands_for if value is None or value == self.default else value


class UnsetAttributes:
    """The meaning of every unset attribute of every class in the versions of some documents."""

    def __init__(self, documents: Iterable[Document]) -> None:
        self.versions = frozenset(document.facts_version for document in documents)
        self._known: dict[tuple[str, type[Element]], dict[str, UnsetAttribute]] = {}

    def of(self, element: Element) -> dict[str, UnsetAttribute]:
        """Those of an object, by the Python names of its attributes."""
        version = self._version(element)
        cls = type(element)
        found = self._known.get((version, cls))
        if found is None:
            attributes = (feature for feature in features_of(cls).values() if feature.kind == "attribute")
            found = {f.name: self._unset(version, cls.__name__, f.xml_name) for f in attributes}
            self._known[version, cls] = found
        return found

    def _version(self, element: Element) -> str:
        if len(self.versions) == 1:
            (version,) = self.versions
            return version
        document = element.document
        assert document
        return document.facts_version

    def _unset(self, version: str, class_name: str, xml_name: str) -> UnsetAttribute:
        default = default_value(facts(version), class_name, xml_name)
        declared = [facts(v) for v in self.versions]
        if any(known.feature(class_name, xml_name) is None for known in declared):
            return UnsetAttribute(default, None, None)
        is_common = all(default_value(known, class_name, xml_name) == default for known in declared)
        return UnsetAttribute(default, default, default if is_common else _VARIES)
