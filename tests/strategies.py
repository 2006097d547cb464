"""Random models of any version, their meaning as plain data, and texts read without a file."""

import math
import struct
import sys
from collections import Counter
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any

from hypothesis import strategies as st

from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.defaults import enum_class
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.metamodel.versions import facts, supported_versions
from amalthea_uros.xmi.emf.reader import read
from amalthea_uros.xmi.emf.references import resolve

FLOAT_TYPES = {"EDouble", "EDoubleObject", "EFloat", "PositiveDouble", "NonNegativeDouble"}
PIECES = ["", "Z9", "  ", "?type=", "%2F", *"a /?=&%+:~*éµ名😀\u00a0#."]
XML_PIECES = [*PIECES, "\r\n", "]]>", "-->", "&amp;", "&#10;", *"<>\"'\n\r\t\u0085\u2028\ufeff"]
FLOATS = [0.0, -0.0, 1.0, -1.5, 0.1, 1 / 3, 1e-3, 9.99e-4, 1e7, 9999999.0, 123456789.125, 5e-324, 1.5e-45, sys.float_info.max]
FLOATS += [math.inf, -math.inf, math.nan, 3.4028234663852886e38, 16777217.0, 1e21, 2**53 + 2.0]
INTEGERS = [0, 1, -1, 7, 10, 255, 2**31 - 1, -(2**31)]
LONGS = [*INTEGERS, 2**63 - 1, -(2**63)]


def parse(*texts: str) -> Model:
    """A model of the texts of its files, `0.amxmi` and so on."""
    results = [read(Path(f"{number}.amxmi"), FileText(text)) for number, text in enumerate(texts)]
    model = Model(result.document for result in results)
    model.findings = tuple(resolve(results, {}))
    return model


# What a version declares


@cache
def stored_features(version: str, class_name: str) -> tuple[tuple[str, Any], ...]:
    """The features of a class that files hold: the Python name and the fact."""
    names = {feature.xml_name: feature.name for feature in features_of(getattr(classes, class_name)).values()}
    found = facts(version).features(class_name)
    return tuple((names[fact.name], fact) for fact in found if fact.stored and not is_container(fact))


def is_container(fact) -> bool:
    return fact.kind is FeatureKind.REFERENCE and fact.opposite is not None


@cache
def concrete(version: str, class_name: str) -> tuple[str, ...]:
    return facts(version).concrete_subtypes(class_name)


@cache
def default_of(version: str, fact) -> Any:
    """What the absence of an attribute stands for."""
    declared = facts(version)
    if fact.type in declared.enums:
        return declared.enums[fact.type].literals[0]
    by_type = {"EInt": 0, "ELong": 0, "Address": 0, "EBoolean": False, "EDouble": 0.0, "EFloat": 0.0}
    if fact.default is None:
        value = by_type.get(fact.type)
    elif fact.type == "EString":
        value = fact.default
    elif fact.type == "EBoolean":
        value = fact.default == "true"
    else:
        value = float(fact.default.rstrip("f")) if fact.type in FLOAT_TYPES else int(fact.default)
    return plain(fact, value)


# Values


def text(rng, pieces: list[str]) -> str:
    return "".join(rng.choice(pieces) for _ in range(rng.randrange(5)))


def value_for(rng, version: str, name: str, fact) -> Any:
    """A random value that the version allows for an attribute."""
    declared = facts(version)
    if fact.type in declared.enums:
        return enum_class(fact.type)(rng.choice(declared.enums[fact.type].literals))
    if fact.type == "EBoolean":
        return rng.random() < 0.5
    if fact.type == "EString":
        return text(rng, PIECES if name == "name" else XML_PIECES)
    if fact.type in FLOAT_TYPES:
        return rng.choice([value for value in FLOATS if is_allowed(declared, fact.type, value)])
    return rng.choice([value for value in integers(declared, fact.type) if is_allowed(declared, fact.type, value)])


def integers(declared, type_name: str) -> list[int]:
    if type_name == "EBigInteger":
        return [*LONGS, 10**300, -(10**40)]
    number = declared.numbers.get(type_name)
    is_int = type_name in ("EInt", "EIntegerObject") or (number is not None and number.java_type == "int")
    return INTEGERS if is_int else LONGS


def is_allowed(declared, type_name: str, value: float) -> bool:
    number = declared.numbers.get(type_name)
    return number is None or (value > number.minimum if number.exclusive else value >= number.minimum)


# Models


class Builder:
    """Makes one random model; `rng` decides everything."""

    def __init__(self, rng, version: str, size: int) -> None:
        self.rng = rng
        self.version = version
        self.left = size
        self.elements: list[Any] = []

    def model(self) -> Model:
        root = self.element("Amalthea", 0)
        model = Model.of(root, self.version)
        # Members of a namespace are named after it, call arguments after what they belong to.
        self.refer(lambda fact: fact.type == "Namespace")
        self.refer(lambda fact: fact.type not in ("Namespace", "CallArgument"))
        self.refer(lambda fact: fact.type == "CallArgument")
        return model

    def element(self, class_name: str, depth: int) -> Any:
        made = getattr(classes, class_name)()
        self.elements.append(made)
        self.left -= 1
        features = stored_features(self.version, class_name)
        for name, fact in features:
            if fact.kind is FeatureKind.ATTRIBUTE and self.rng.random() < (0.9 if name == "name" else 0.4):
                setattr(made, name, value_for(self.rng, self.version, name, fact))
        if made.is_referable and self.rng.random() < 0.8:
            made.name = f"{made.name or ''}{self.left}"
        parts = [(name, fact) for name, fact in features if fact.kind is FeatureKind.CONTAINMENT]
        self.rng.shuffle(parts)
        for name, fact in parts:
            self.fill(made, name, fact, depth)
        return made

    def fill(self, holder: Any, name: str, fact, depth: int) -> None:
        """Give an object some parts of one kind."""
        likely = 0.15 if name == "custom_properties" else 0.6
        if depth >= 7 or self.left <= 0 or self.rng.random() > likely:
            return
        choices = concrete(self.version, fact.type)
        if not choices:
            return
        feature = features_of(type(holder))[name]
        count = self.rng.randint(1, 4 if depth == 1 else 2) if fact.many else 1
        parts = [self.element(self.rng.choice(choices), depth + 1) for _ in range(count)]
        setattr(holder, name, parts if feature.many else parts[0])

    def refer(self, is_meant) -> None:
        """Let objects refer to others, of which there is only one with that name and class."""
        names = Counter(element.unique_name for element in self.elements if element.is_referable)
        targets = [element for element in self.elements if element.is_referable and names[element.unique_name] == 1]
        for holder in self.elements:
            for name, fact in stored_features(self.version, type(holder).__name__):
                if fact.kind is not FeatureKind.REFERENCE or not is_meant(fact):
                    continue
                fitting = [target for target in targets if isinstance(target, getattr(classes, fact.type))]
                if fitting and self.rng.random() < 0.7:
                    self.set_reference(holder, name, fitting, fact.many)

    def set_reference(self, holder: Any, name: str, fitting: list[Any], many: bool) -> None:
        count = self.rng.randint(1, 3) if many else 1
        chosen = [self.rng.choice(fitting) for _ in range(count)]
        is_list = features_of(type(holder))[name].many
        setattr(holder, name, chosen if is_list else chosen[0])


@st.composite
def models(draw, size: int = 25, versions: tuple[str, ...] = supported_versions()) -> Model:
    """A model of a random version with about that many objects."""
    rng = draw(st.randoms(use_true_random=False))
    return Builder(rng, draw(st.sampled_from(versions)), draw(st.integers(1, size))).model()


# Meaning


def meaning(*roots: Any, version: str) -> list[Any]:
    """Everything that models say, as plain data: equal for equal models, however they are spelled."""
    places: dict[Any, str] = {}
    for number, root in enumerate(roots):
        note_places(version, root, f"{number}:", places)
    return [element_meaning(version, root, places) for root in roots]


def note_places(version: str, element: Any, place: str, places: dict[Any, str]) -> None:
    places[element] = place
    for name, fact in stored_features(version, type(element).__name__):
        if fact.kind is FeatureKind.CONTAINMENT:
            for number, part in enumerate(as_list(getattr(element, name))):
                note_places(version, part, f"{place}/{name}.{number}", places)


def element_meaning(version: str, element: Any, places: dict[Any, str]) -> Any:
    found: dict[str, Any] = {}
    for name, fact in stored_features(version, type(element).__name__):
        value = getattr(element, name)
        if fact.kind is FeatureKind.ATTRIBUTE:
            said = default_of(version, fact) if value is None else plain(fact, value)
            if said is not None:
                found[name] = said
        elif as_list(value) and fact.kind is FeatureKind.REFERENCE:
            found[name] = [places.get(target, target.unresolved) for target in as_list(value)]
        elif as_list(value):
            found[name] = [element_meaning(version, part, places) for part in as_list(value)]
    return type(element).__name__, found


def as_list(value: Any) -> list[Any]:
    if value is None:
        return []
    return value if isinstance(value, list) else [value]


def plain(fact, value: Any) -> Any:
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, float):
        return repr(as_single(value) if fact.type == "EFloat" else value)
    return value


def as_single(value: float) -> float:
    """The nearest number that a Java `float` holds."""
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
