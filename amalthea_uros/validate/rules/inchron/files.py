"""Versions, sub-models and content of files."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element, extras_if_any
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.features import containments_of, features_of
from amalthea_uros.metamodel.source import Prefixes
from amalthea_uros.metamodel.versions import VersionFacts, facts, spelled
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, changes, model_rule
from amalthea_uros.validate.rules.inchron.importer import attributes_at, metamodel_of, tag_of

#: The versions that am2inc supports.
VERSIONS = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0")


@model_rule("INC-IO-VERSION", am.Amalthea, is_about_files=True)
def _check_version(element: am.Amalthea, context: Context) -> Iterator[str | Downgraded]:
    document = element.document
    if document is not None and document.file_version not in VERSIONS:
        message = f"{spelled(document.file_version)} is not supported by am2inc"
        yield Downgraded(message) if document.migrated_from is None else message


@model_rule("INC-IO-SAMEVERSION", am.Amalthea)
def _check_same_version(element: am.Amalthea, context: Context) -> Iterator[str]:
    first, *others = context.model.documents
    document = element.document
    if document in others and metamodel_of(document) != metamodel_of(first):
        other = repr(first.path.name) if first.path else "the first file"
        yield f"the file uses {spelled(document.file_version)}, but {other} uses {first.file_version}"


@model_rule("INC-IO-SUBMODEL-ONCE", am.Amalthea)
def _check_sub_models(element: am.Amalthea, context: Context) -> Iterator[str]:
    holders = context.once(_holders)
    for part in element.contents():
        first = holders.get(type(part), element)
        if first is not element:
            document = first.document
            other = repr(document.path.name) if document is not None and document.path else "another file"
            yield f"the {type(part).__name__} replaces the one in {other}"


def _holders(context: Context) -> dict[type[Element], Element]:
    """The root of the first file that has a sub-model, by class of sub-model."""
    found: dict[type[Element], Element] = {}
    for document in context.model.documents:
        for part in document.root.contents():
            if not isinstance(part, am.CustomProperty):
                found.setdefault(type(part), document.root)
    return found


#: What the types of numbers end with.
_NUMBERS = ("Int", "Long", "BigInteger", "Integer", "Float", "Double")

_TAG = re.compile(r"<(?P<name>[^\s/>!?]+)").match


@model_rule("INC-IO-FEATURE", Element, is_about_files=True)
def _check_feature(element: Element, context: Context) -> Iterator[str | Downgraded]:
    document = context.document_of(element)
    version = metamodel_of(document)
    if "_extras" not in element.__dict__ and _is_same(type(element).__name__, context.version_of(element), version):
        return
    known = facts(version)
    class_name = type(element).__name__
    if class_name not in known.classes:
        declared = _declared(element, known)
        if declared is None:
            return
        if _xsi_type(element) is not None:
            yield f"the class {class_name} does not exist in AMALTHEA {known.version}"
            return
        class_name = declared
    yield from _not_read(element, class_name, known)
    held = _features(class_name, known.version)
    for name in [name for name, value in element.__dict__.items() if name not in held and value not in (None, [])]:
        feature = features_of(type(element))[name]
        message = f"{class_name} has no feature {feature.xml_name!r} in AMALTHEA {known.version}"
        yield message if feature.kind == "containment" else Downgraded(message)
    for name, literals in _literals(class_name, known.version):
        value = element.__dict__.get(name)
        if value is not None and value not in literals:
            yield f"{str(value)!r} is not a valid {name.replace('_', ' ')} of {class_name} in AMALTHEA {known.version}"


@cache
def _is_same(class_name: str, version: str, other: str) -> bool:
    """Whether another version has the class with at least the same features and literals."""
    if class_name not in facts(other).classes:
        return False
    return _features(class_name, version) <= _features(class_name, other) and all(
        literals <= dict(_literals(class_name, other))[name] for name, literals in _literals(class_name, version)
    )


def _declared(element: Element, known: VersionFacts) -> str | None:
    """The declared class of the feature that holds an object; None if there is no such feature, which is reported for its holder."""
    holder = element.container
    if holder is None or type(holder).__name__ not in known.classes:
        return None
    feature = next(feature for feature in containments_of(type(holder)) if _holds(holder.__dict__.get(feature.name), element))
    declared = known.feature(type(holder).__name__, feature.xml_name)
    return declared.type if declared is not None else None


def _holds(value: object, element: Element) -> bool:
    return value is element or (isinstance(value, list) and element in value)


def _xsi_type(element: Element) -> str | None:
    """The `xsi:type` of an object in its file, with its prefix; None if it has none."""
    tag = tag_of(element)
    return None if tag is None else tag[1].get(tag[0].prefixes.xsi_type)


def _not_read(element: Element, class_name: str, known: VersionFacts) -> Iterator[str | Downgraded]:
    """Messages about attributes and elements that were preserved although the metamodel has no place for them."""
    extras, document = extras_if_any(element), element.document
    if extras is None or document is None:
        return
    own = facts(document.facts_version)
    for name, text in extras.attributes.items():
        feature = known.feature(class_name, name)
        if feature is None and not name.startswith("xmlns"):
            yield Downgraded(f"{class_name} has no attribute {name!r} in AMALTHEA {known.version}")
        elif feature is not None and own.feature(class_name, name) and not _is_literal(text, feature.type, known):
            message = f"{text!r} is not a valid value of the attribute {name!r} of {class_name}"
            # Numbers are not checked: what is read is 0, the digits at the beginning, or any value.
            yield (
                changes(f"{message}; am2inc reads another number")
                if feature.type.removesuffix("Object").endswith(_NUMBERS)
                else message
            )
    prefixes = document.source.prefixes if document.source is not None else Prefixes()
    for _, raw in extras.content:
        tag = _TAG(raw)
        if tag is not None:
            given = attributes_at(raw).get(prefixes.xsi_type, "").removeprefix(prefixes.type_prefix)
            yield from _misplaced(class_name, tag["name"], given, known)


def _is_literal(text: str, type_name: str, known: VersionFacts) -> bool:
    enum = known.enums.get(type_name)
    return enum is not None and text in enum.literals


def _misplaced(class_name: str, name: str, given: str, known: VersionFacts) -> Iterator[str]:
    """Why an element is not allowed in its place. A second element where only one is allowed is not reported here."""
    feature = known.feature(class_name, name)
    if feature is None:
        yield f"{class_name} has no element <{name}> in AMALTHEA {known.version}"
    elif feature.kind is FeatureKind.CONTAINMENT and (given or feature.type) not in _parts(feature.type, known.version):
        yield f"the element <{name}> of {class_name} cannot be of the class {given or feature.type} in AMALTHEA {known.version}"


@cache
def _parts(class_name: str, version: str) -> frozenset[str]:
    """The classes of the objects that are allowed where a class is declared."""
    return frozenset(facts(version).concrete_subtypes(class_name))


@cache
def _features(class_name: str, version: str) -> frozenset[str]:
    """The Python names of the features of a class in a version, and the attribute for preserved content."""
    known = {feature.name for feature in facts(version).features(class_name)}
    held = features_of(getattr(classes, class_name)).items()
    return frozenset({"_extras", *(name for name, feature in held if feature.xml_name in known)})


@cache
def _literals(class_name: str, version: str) -> tuple[tuple[str, frozenset[str]], ...]:
    """The attributes of a class that take literals, with the literals of a version."""
    known = facts(version)
    types = {feature.name: feature.type for feature in known.features(class_name)}
    held = features_of(getattr(classes, class_name)).items()
    enums = {name: known.enums.get(types.get(feature.xml_name, "")) for name, feature in held}
    return tuple((name, frozenset(enum.literals)) for name, enum in enums.items() if enum is not None)
