"""Number out of range."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import NumberFact
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._facts import per_class, stored_features


def _check(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, xml_name, number in _limited(type(element), context.version_of(element)):
        value = values.get(name)
        if value is not None and (value < number.minimum or (number.exclusive and value == number.minimum)):
            limit = f"{'greater than' if number.exclusive else 'at least'} {number.minimum}"
            yield f"the {xml_name} of the {type(element).__name__} is {value}, but must be {limit}"


@per_class
def _limited(cls: type[Element], version: str) -> tuple[tuple[str, str, NumberFact], ...]:
    """The attributes whose type has a limit, by Python and XML name."""
    numbers = facts(version).numbers
    features = stored_features(cls, version).items()
    return tuple((name, fact.name, numbers[fact.type]) for name, fact in features if fact.type in numbers)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/datatype",
    title="number out of range",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
    concerns=_limited,
    rationale="The value is meaningless, for example a counter that divides by 0. APP4MC's validation also reports it.",
    remedy="Set a value within the range.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="S?type=Runnable">
        <counter prescaler="0"/>
      </items>
    </activityGraph>
  </runnables>
  <runnables name="S"/>
</swModel>
""",
    edits={'prescaler="0"': 'prescaler="2"'},
)
