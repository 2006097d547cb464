"""Automatic repair of findings that can be repaired in exactly one way."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.engine import concerned
from amalthea_uros.validate.rule import ModelCheck


@dataclass(frozen=True, slots=True)
class Repairs:
    """The changes to a model.

    Attributes
    ----------
    done : the number of repaired objects by the id of the rule
    changed : the documents that were changed
    rewritten : the changed documents that must be written in canonical form
    """

    done: Counter[str] = field(default_factory=Counter)
    changed: set[Document] = field(default_factory=set)
    rewritten: set[Document] = field(default_factory=set)


def repair(model: Model, rules: Iterable[ModelCheck]) -> Repairs:
    """Repair the findings of rules in a model where possible."""
    repairs = Repairs()
    for rule in rules:
        if rule.fix is None and not rule.in_canonical_form:
            continue
        # A new context, because earlier rules may have changed the model.
        context = Context(model)
        for element in list(_with_findings(rule, context)):
            document = element.document
            if document is not None and (rule.fix is None or rule.fix(element, context)):
                repairs.done[rule.id] += 1
                repairs.changed.add(document)
                if rule.in_canonical_form:
                    repairs.rewritten.add(document)
    return repairs


def _with_findings(rule: ModelCheck, context: Context) -> Iterator[Element]:
    for element in concerned(rule, context):
        try:
            if any(rule.check(element, context)):
                yield element
        except Exception:  # a bug in the rule, reported when the rule is run
            continue
