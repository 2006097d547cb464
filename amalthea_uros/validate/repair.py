"""Repairs what rules find, where there is one way to."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.engine import concerned
from amalthea_uros.validate.rule import ModelRule


@dataclass(frozen=True, slots=True)
class Repairs:
    """What was done to a model.

    Attributes
    ----------
    done : how many objects were repaired, by the id of the rule
    changed : the documents in which something changed
    rewritten : those of them that have to be written in canonical form
    """

    done: Counter[str] = field(default_factory=Counter)
    changed: set[Document] = field(default_factory=set)
    rewritten: set[Document] = field(default_factory=set)


def repair(model: Model, rules: Iterable[ModelRule]) -> Repairs:
    """Change a model such that rules fire less often."""
    repairs = Repairs()
    for rule in rules:
        if rule.fix is None and not rule.in_canonical_form:
            continue
        # What other rules changed counts.
        context = Context(model)
        for element in list(_faulty(rule, context)):
            document = element.document
            if document is not None and (rule.fix is None or rule.fix(element, context)):
                repairs.done[rule.id] += 1
                repairs.changed.add(document)
                if rule.in_canonical_form:
                    repairs.rewritten.add(document)
    return repairs


def _faulty(rule: ModelRule, context: Context) -> Iterator[Element]:
    for element in concerned(rule, context):
        try:
            if any(rule.check(element, context)):
                yield element
        except Exception:  # a mistake of the rule, which is told when it is run
            continue
