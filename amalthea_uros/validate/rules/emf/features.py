"""What the metamodel demands of the features of a class: values, their number and range, and unique keys."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import TypeVar

from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureFact, NumberFact
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.validate.content import is_same
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule, repair_of

T = TypeVar("T")


def per_class(find: Callable[[type[Element], str], T]) -> Callable[[type[Element], str], T]:
    """Cache the result of a function by class and version; it is called for each object."""
    known: dict[tuple[type[Element], str], T] = {}

    def found(cls: type[Element], version: str) -> T:
        if (cls, version) not in known:
            known[cls, version] = find(cls, version)
        return known[cls, version]

    return found


def stored_features(cls: type[Element], version: str) -> dict[str, FeatureFact]:
    """The features of a class that files of a version contain, in the order in which EMF writes them."""
    declared = facts(version)
    names = {feature.xml_name: name for name, feature in features_of(cls).items()}
    stored = declared.features(cls.__name__) if cls.__name__ in declared.classes else ()
    return {names[fact.name]: fact for fact in stored if fact.stored}


@per_class
def _required(cls: type[Element], version: str) -> tuple[tuple[str, str], ...]:
    """The single features that need a value, and that have none by default, by Python and XML name."""
    declared = facts(version)
    features = stored_features(cls, version).items()
    return tuple((name, f.name) for name, f in features if f.required and not f.many and declared.default(f) is None)


@model_rule("AM-EMF-INTRINSIC/required-feature", Element, concerns=_required)
def _check_required_feature(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, xml_name in _required(type(element), context.version_of(element)):
        if values.get(name) is None:
            yield f"the {type(element).__name__} has no {xml_name}"


@per_class
def _bounded(cls: type[Element], version: str) -> tuple[tuple[str, FeatureFact], ...]:
    features = stored_features(cls, version).items()
    return tuple((name, fact) for name, fact in features if fact.many and (fact.lower or fact.upper is not None))


@model_rule("AM-EMF-INTRINSIC/multiplicity", Element, concerns=_bounded)
def _check_multiplicity(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, fact in _bounded(type(element), context.version_of(element)):
        number = len(values.get(name, ()))
        if number < fact.lower or (fact.upper is not None and number > fact.upper):
            yield f"the {type(element).__name__} has {counted(number, 'value')} of {fact.name}, but needs {_required_number(fact)}"


def _required_number(fact: FeatureFact) -> str:
    if fact.upper is None:
        return f"at least {fact.lower}"
    return f"{fact.lower}" if fact.lower == fact.upper else f"{fact.lower} to {fact.upper}"


@per_class
def _limited(cls: type[Element], version: str) -> tuple[tuple[str, str, NumberFact], ...]:
    """The attributes whose type has a limit, by Python and XML name."""
    numbers = facts(version).numbers
    features = stored_features(cls, version).items()
    return tuple((name, fact.name, numbers[fact.type]) for name, fact in features if fact.type in numbers)


@model_rule("AM-EMF-INTRINSIC/datatype", Element, concerns=_limited)
def _check_datatype(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, xml_name, number in _limited(type(element), context.version_of(element)):
        value = values.get(name)
        if value is not None and (value < number.minimum or (number.exclusive and value == number.minimum)):
            limit = f"{'greater than' if number.exclusive else 'at least'} {number.minimum}"
            yield f"the {xml_name} of the {type(element).__name__} is {value}, but must be {limit}"


@per_class
def _maps(cls: type[Element], version: str) -> tuple[tuple[str, str], ...]:
    """The features that are maps, by Python and XML name."""
    classes = facts(version).classes
    features = stored_features(cls, version).items()
    return tuple(
        (name, fact.name) for name, fact in features if fact.many and fact.type in classes and classes[fact.type].entry
    )


@model_rule("AM-EMF-INTRINSIC/map-entry-unique", Element, concerns=_maps)
def _check_map_entry_unique(element: Element, context: Context) -> Iterator[str]:
    for name, xml_name in _maps(type(element), context.version_of(element)):
        entries = element.__dict__.get(name, ())
        if len(entries) < 2:
            continue
        for key, times in Counter(entry.key for entry in entries).items():
            if times > 1:
                yield f"{xml_name} contains the key {_shown(key)} {times} times"


@repair_of("AM-EMF-INTRINSIC/map-entry-unique")
def _fix_map_entry_unique(element: Element, context: Context) -> bool:
    """Drop exact repetitions of entries; only the author can choose between different values."""
    repaired = False
    for name, _ in _maps(type(element), context.version_of(element)):
        entries = element.__dict__.get(name, [])
        for entry in list(entries):
            if any(is_same(entry, other) for other in entries[: entries.index(entry)]):
                entries.remove(entry)
                repaired = True
    return repaired


def _shown(key: str | Element | None) -> str:
    return repr(key.qualified_name if isinstance(key, Element) else key)
