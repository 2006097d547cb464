"""EMF's form of files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.defaults import default_value
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.rules.emf.features import per_class, stored_features


@model_rule("EMF-DEFAULT", am.Amalthea, in_canonical_form=True)
def _check_default(element: am.Amalthea, context: Context) -> Iterator[str]:
    document = element.document
    if document is None or document.source is None or document.migrated_from is not None:
        return
    omitted = [
        part.__dict__.get(name) == value
        for cls, parts in context.by_class(Element)
        if (features := _omitted(cls, document.facts_version))
        for part in parts
        if context.document_of(part) is document
        for name, value in features
    ]
    number = sum(omitted)
    if number:
        yield f"the file sets {counted(number, 'attribute')} to the default value, which EMF does not write"


@per_class
def _omitted(cls: type[Element], version: str) -> tuple[tuple[str, object], ...]:
    """The attributes that EMF omits if they have a certain value, with this value."""
    declared = facts(version)
    found = (
        (name, default_value(declared, cls.__name__, fact.name))
        for name, fact in stored_features(cls, version).items()
        if fact.default is None
    )
    return tuple((name, value) for name, value in found if value is not None)


@model_rule("EMF-ORDER", am.Amalthea, in_canonical_form=True)
def _check_order(element: am.Amalthea, context: Context) -> Iterator[str]:
    document = element.document
    if document is None or document.source is None or document.migrated_from is not None:
        return
    index = document.source.index
    moved = 0
    for cls, holders in context.by_class(Element):
        names = _containments(cls, document.facts_version)
        for holder in holders if names else ():
            moved += _moved(holder, names, index)
    if moved:
        yield f"the order of objects differs from EMF's order in {counted(moved, 'place')}"


def _moved(holder: Element, names: Iterable[str], index: Mapping[Element, int]) -> int:
    """How often a part of an object precedes, in the file, a part that EMF writes before it."""
    moved, last = 0, -1
    for name in names:
        value = holder.__dict__.get(name)
        if value is not None:
            for part in value if isinstance(value, list) else (value,):
                place = index.get(part, last)
                moved += place < last
                last = place
    return moved


@per_class
def _containments(cls: type[Element], version: str) -> tuple[str, ...]:
    return tuple(name for name, fact in stored_features(cls, version).items() if fact.kind is FeatureKind.CONTAINMENT)


@model_rule("EMF-ID", am.Amalthea, in_canonical_form=True)
def _check_id(element: am.Amalthea, context: Context) -> Iterator[str]:
    document = element.document
    if document is None or document.source is None or document.migrated_from is not None:
        return
    source = document.source
    stated = len(re.findall(rf"\s{re.escape(source.prefixes.xmi_id)}\s*=", source.text))
    referable = sum(part.is_referable for part in source.elements)
    if stated < referable:
        yield f"the file has no xmi:id for {referable - stated} of {counted(referable, 'referable object')}"
    odd = sum(name == "xmi:id" for _, name in document.spellings)
    if odd:
        yield f"the xmi:id does not match the name of {counted(odd, 'object')}"
