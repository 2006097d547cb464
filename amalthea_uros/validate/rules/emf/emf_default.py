"""Explicit default values."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.defaults import default_value
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf.features import per_class, stored_features


def _check(element: Amalthea, context: Context) -> Iterator[str]:
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


RULE = ModelRule(
    id="EMF-DEFAULT",
    title="explicit default values",
    severity=Severity.INFO,
    target=Amalthea,
    check=_check,
    rationale="Explicit default values have no effect, and the next tool that saves the model removes them.",
    remedy="Rewrite the file with amuros check --fix, amuros fmt or APP4MC.",
    fails="""
<swModel>
  <tasks name="T" preemption="_undefined_"/>
</swModel>
""",
    edits={'preemption="_undefined_"': 'preemption="preemptive"'},
    in_canonical_form=True,
)
