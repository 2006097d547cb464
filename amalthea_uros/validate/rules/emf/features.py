"""What the metamodel demands of the features of a class: values, their number and range, and unique keys."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import TypeVar

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureFact, NumberFact
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.validate.content import is_same
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule

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


def _check_required_feature(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, xml_name in _required(type(element), context.version_of(element)):
        if values.get(name) is None:
            yield f"the {type(element).__name__} has no {xml_name}"


@per_class
def _required(cls: type[Element], version: str) -> tuple[tuple[str, str], ...]:
    """The single features that need a value, and that have none by default, by Python and XML name."""
    declared = facts(version)
    features = stored_features(cls, version).items()
    return tuple((name, f.name) for name, f in features if f.required and not f.many and declared.default(f) is None)


def _check_multiplicity(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, fact in _bounded(type(element), context.version_of(element)):
        number = len(values.get(name, ()))
        if number < fact.lower or (fact.upper is not None and number > fact.upper):
            yield f"the {type(element).__name__} has {counted(number, 'value')} of {fact.name}, but needs {_required_number(fact)}"


@per_class
def _bounded(cls: type[Element], version: str) -> tuple[tuple[str, FeatureFact], ...]:
    features = stored_features(cls, version).items()
    return tuple((name, fact) for name, fact in features if fact.many and (fact.lower or fact.upper is not None))


def _required_number(fact: FeatureFact) -> str:
    if fact.upper is None:
        return f"at least {fact.lower}"
    return f"{fact.lower}" if fact.lower == fact.upper else f"{fact.lower} to {fact.upper}"


def _check_datatype(element: Element, context: Context) -> Iterator[str]:
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


def _check_map_entry_unique(element: Element, context: Context) -> Iterator[str]:
    for name, xml_name in _maps(type(element), context.version_of(element)):
        entries = element.__dict__.get(name, ())
        if len(entries) < 2:
            continue
        for key, times in Counter(entry.key for entry in entries).items():
            if times > 1:
                yield f"{xml_name} contains the key {_shown(key)} {times} times"


@per_class
def _maps(cls: type[Element], version: str) -> tuple[tuple[str, str], ...]:
    """The features that are maps, by Python and XML name."""
    classes = facts(version).classes
    features = stored_features(cls, version).items()
    return tuple(
        (name, fact.name) for name, fact in features if fact.many and fact.type in classes and classes[fact.type].entry
    )


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


RULES = (
    ModelRule(
        id="AM-EMF-INTRINSIC/required-feature",
        title="missing required value",
        severity=Severity.ERROR,
        target=Element,
        check=_check_required_feature,
        concerns=_required,
        rationale="Other objects and the tools that read the model rely on the value. APP4MC's validation also reports it.",
        remedy="Set the value.",
        fails=runnable_with('<items xsi:type="am:RunnableCall"/>'),
        edits={
            'xsi:type="am:RunnableCall"': 'xsi:type="am:RunnableCall" runnable="S?type=Runnable"',
            "</swModel>": """  <runnables name="S"/>
</swModel>""",
        },
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/multiplicity",
        title="wrong number of values",
        severity=Severity.ERROR,
        target=Element,
        check=_check_multiplicity,
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
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/datatype",
        title="number out of range",
        severity=Severity.ERROR,
        target=Element,
        check=_check_datatype,
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
    ),
    ModelRule(
        id="AM-EMF-INTRINSIC/map-entry-unique",
        title="duplicate key in a map",
        severity=Severity.ERROR,
        target=Element,
        check=_check_map_entry_unique,
        concerns=_maps,
        fix=_fix_map_entry_unique,
        rationale="Only one of the values takes effect, and which one is undefined. APP4MC's validation also reports it.",
        remedy="Define each key only once.",
        fails="""
<swModel>
  <tasks name="T">
    <customProperties key="k">
      <value xsi:type="am:StringObject" value="1"/>
    </customProperties>
    <customProperties key="k">
      <value xsi:type="am:StringObject" value="2"/>
    </customProperties>
  </tasks>
</swModel>
""",
        edits={
            """    <customProperties key="k">
      <value xsi:type="am:StringObject" value="2"/>
    </customProperties>
""": "",
        },
    ),
)
