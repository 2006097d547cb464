"""Non-standard order of objects."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf.features import per_class, stored_features


def _check(element: Amalthea, context: Context) -> Iterator[str]:
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


RULE = ModelRule(
    id="EMF-ORDER",
    title="non-standard order of objects",
    severity=Severity.INFO,
    target=Amalthea,
    check=_check,
    rationale="The next tool that saves the model reorders the objects, which hides the real changes in a diff.",
    remedy="Rewrite the file with amuros check --fix, amuros fmt or APP4MC.",
    fails="""
<stimuliModel/>
<swModel/>
""",
    passes="""
<swModel/>
<stimuliModel/>
""",
    in_canonical_form=True,
)
