"""Wrong number of values."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureFact
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._facts import per_class, stored_features


def _check(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, fact in _bounded(type(element), context.version_of(element)):
        number = len(values.get(name, ()))
        if number < fact.lower or (fact.upper is not None and number > fact.upper):
            yield f"the {type(element).__name__} has {counted(number, 'value')} of {fact.name}, but needs {_required(fact)}"


@per_class
def _bounded(cls: type[Element], version: str) -> tuple[tuple[str, FeatureFact], ...]:
    features = stored_features(cls, version).items()
    return tuple((name, fact) for name, fact in features if fact.many and (fact.lower or fact.upper is not None))


def _required(fact: FeatureFact) -> str:
    if fact.upper is None:
        return f"at least {fact.lower}"
    return f"{fact.lower}" if fact.lower == fact.upper else f"{fact.lower} to {fact.upper}"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/multiplicity",
    title="wrong number of values",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
    concerns=_bounded,
    rationale="Tools rely on the number of values that the metamodel requires. APP4MC's validation also reports it.",
    remedy="Add or remove values until their number is within the required range.",
    fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainSynchronizationConstraint" name="C" scope="A?type=EventChain"/>
  <eventChains name="A"/>
</constraintsModel>
""",
    edits={
        'scope="A?type=EventChain"': 'scope="A?type=EventChain B?type=EventChain"',
        "</constraintsModel>": """  <eventChains name="B"/>
</constraintsModel>""",
    },
)
