"""Numbers that are equal for objects with equal content, whatever unset attributes mean in their versions."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

from amalthea_uros.difference.names import has_identity
from amalthea_uros.metamodel.classes_common import ListObject
from amalthea_uros.metamodel.classes_constraints import AbstractEventChain
from amalthea_uros.metamodel.classes_sw import IActivityGraphItemContainer, ModeSwitch, Switch
from amalthea_uros.metamodel.containment import ContainmentList
from amalthea_uros.metamodel.defaults import default_value
from amalthea_uros.metamodel.element import Element, Extras
from amalthea_uros.metamodel.features import ElementFeature, features_of
from amalthea_uros.metamodel.versions import facts

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable

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


# Numbers that are equal for objects with equal content

#: Classes with ordered parts, and the feature that contains them; all other parts are unordered.
_SEQUENCES = (
    (IActivityGraphItemContainer, "items"),
    (AbstractEventChain, "items"),
    (ModeSwitch, "entries"),
    (Switch, "entries"),
    (ListObject, "values"),
)

_LAYOUT = re.compile(r"(?<=>)\s+(?=<)")


def is_sequence(cls: type[Element], feature_name: str) -> bool:
    """Whether the order of the parts in a feature (its Python name) has a meaning."""
    return any(feature_name == name and issubclass(cls, holder) for holder, name in _SEQUENCES)


def unknown_content(extras: Extras | None) -> dict[str, tuple[str, ...]]:
    """The unknown attributes and elements of an object by name; comments and the layout are no content."""
    if extras is None:
        return {}
    attributes = {name: text for name, text in extras.attributes.items() if not name.startswith("xmlns")}
    found: dict[str, tuple[str, ...]] = {name: (text,) for name, text in attributes.items()}
    for _, raw in extras.content:
        if not raw.startswith(("<!--", "<?")):
            tag = re.match(r"<([^\s/>]+)", raw)
            name = tag[1] if tag else "text"
            found[name] = (*found.get(name, ()), _LAYOUT.sub("", raw))
    return found


class Fingerprints:
    """The fingerprints of objects of one model.

    Parameters
    ----------
    unset_attributes : of the models to be compared
    token : the token of the target of a reference
    numbers : the fingerprints given out, shared by the models to be compared
    stops : whether a part counts by its token only, or not at all (None), instead of by its content
    """

    def __init__(
        self,
        unset_attributes: UnsetAttributes,
        token: Callable[[Element], Hashable],
        numbers: dict[Hashable, int],
        stops: Callable[[Element], bool] | None = None,
    ) -> None:
        self._unset_attributes = unset_attributes
        self._token = token
        self._numbers = numbers
        self._stops = stops
        self._known: dict[Element, int] = {}

    def of(self, element: Element) -> int:
        """The fingerprint of an object with its parts."""
        number = self._known.get(element)
        if number is None:
            number = self._known[element] = self._number(element, self._facts(element))
        return number

    def nameless(self, element: Element) -> int:
        """The fingerprint of an object whatever its own name is."""
        return self._number(element, [fact for fact in self._facts(element) if fact[0] != "name"])

    def shallow(self, element: Element) -> int:
        """The fingerprint of an object without its parts."""
        parts = {feature.name for feature in features_of(type(element)).values() if feature.kind == "containment"}
        return self._number(element, [fact for fact in self._facts(element) if fact[0] not in parts])

    def _number(self, element: Element, facts: list[tuple[str, Hashable]]) -> int:
        return self._numbers.setdefault((type(element), *facts), len(self._numbers))

    def _facts(self, element: Element) -> list[tuple[str, Hashable]]:
        """The values that differ from the defaults, by feature, in an order that depends on the names only."""
        unset_attributes = self._unset_attributes.of(element)
        values = element.__dict__
        facts: list[tuple[str, Any]] = []
        for name, value in values.items():
            unset = unset_attributes.get(name)
            if unset is not None:
                value = unset.meaning(value)
                if value != unset.common:
                    facts.append((name, value))
            elif value:
                content = self._content(element, name, value)
                if content:
                    facts.append((name, content))
        if len(self._unset_attributes.versions) > 1:
            facts += self._varying(values, unset_attributes)
        facts.sort(key=_name)
        return facts

    def _varying(self, values: dict[str, Any], unset_attributes: dict[str, Any]) -> list[tuple[str, Any]]:
        return [(n, a.stands_for) for n, a in unset_attributes.items() if n not in values and a.common != a.stands_for]

    def _content(self, element: Element, name: str, value: Any) -> Hashable:
        if type(value) is ContainmentList:
            parts = [self._part(part) for part in value if self._stops or not has_identity(part)]
            return tuple(parts if is_sequence(type(element), name) else sorted(parts, key=repr))
        if isinstance(value, list):
            return tuple(map(self._token, value))
        if isinstance(value, Extras):
            return tuple(sorted(unknown_content(value).items()))
        feature: ElementFeature = features_of(type(element))[name]
        if not feature.contains(value):
            return self._token(value)
        return None if has_identity(value) and not self._stops else (self._part(value),)

    def _part(self, part: Element) -> Hashable:
        return self._token(part) if self._stops and self._stops(part) else self.of(part)


def _name(fact: tuple[str, Any]) -> str:
    return fact[0]
