"""How objects of each class are read and written in one AMALTHEA version: the facts in a form for the inner loops."""

from __future__ import annotations

from functools import cache
from typing import Any

from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import VersionFacts, facts
from amalthea_uros.xmi.emf.data_types import DataType, ValueCache, data_type_of

#: Prefix of class names in `xsi:type`.
TYPE_PREFIX = "am:"

#: The number of waves in which references are resolved, and that of references to namespaces.
WAVES, NAMESPACES = 3, 0


def wave_of(target: type[Element]) -> int:
    """The wave of references to a class: names of members of a namespace need the namespace, those of call arguments the call."""
    return NAMESPACES if target is classes.Namespace else 2 if issubclass(classes.CallArgument, target) else 1


class FeaturePlan:
    """One feature of a class in one version.

    Attributes
    ----------
    name, xml_name : the Python name and that of the file format
    many : whether it is held as a list; `only_one` if this version nevertheless allows one value only
    data_type : how values are written, None for references and parts
    parsed : the values of texts for the reader, None where the text is the value
    wave : that in which references are resolved
    omitted : the value that EMF does not write because absence means the same; None if there is no such value
    default_text : what is written for an unset attribute, as by EMF (it has an explicit default), None if nothing
    target : the class of references and parts
    """

    __slots__ = (
        "data_type",
        "default_text",
        "is_reference",
        "is_string",
        "many",
        "name",
        "omitted",
        "only_one",
        "parsed",
        "parts",
        "target",
        "target_is_abstract",
        "wave",
        "xml_name",
    )

    def __init__(self, name: str, many: bool, fact: FeatureFact, declared: VersionFacts, class_name: str) -> None:
        self.name = name
        self.xml_name = fact.name
        self.many = many
        self.only_one = many and not fact.many
        self.is_reference = fact.kind is FeatureKind.REFERENCE
        self.data_type: DataType | None = None
        self.target: type[Element] = Element
        self.target_is_abstract = False
        self.default_text: str | None = None
        self.omitted: Any = None
        if fact.kind is FeatureKind.ATTRIBUTE:
            self.data_type = data_type_of(declared, fact.type)
            default = declared.default(fact)
            if default is not None:
                value = self.data_type.parse(default)
                if fact.default is None:
                    self.omitted = value
                elif not _has_to_be_stated(class_name, fact):
                    self.default_text = self.data_type.format(value)
        else:
            self.target = getattr(classes, fact.type)
            self.target_is_abstract = declared.classes[fact.type].abstract
        self.is_string = fact.type == "EString"
        self.parsed = ValueCache(self.data_type.parse) if self.data_type and not self.is_string else None
        self.wave = wave_of(self.target)
        #: Plans of the objects that this feature may contain, by `xsi:type`; filled while reading.
        self.parts: dict[str | None, ClassPlan] = {}


#: Optional numbers that have a default, and without which an object nevertheless says nothing, or something else.
_NUMBERS = {
    "ArrivalCurveEntry": ("numberOfOccurrences",),
    "CPUPercentageRequirementLimit": ("limitValue",),
    "ChannelReceive": ("elements",),
    "ChannelSend": ("elements",),
    "CountRequirementLimit": ("limitValue",),
    "DataRate": ("value",),
    "DataSize": ("value",),
    "MinAvgMaxStatistic": ("min", "avg", "max"),
    "PercentageRequirementLimit": ("limitValue",),
    "SingleValueStatistic": ("value",),
    "Time": ("value",),
}


def _has_to_be_stated(class_name: str, fact: FeatureFact) -> bool:
    """Whether the absence of a value does not mean the default: a mandatory upper bound that nobody stated is unknown, not 0.

    EMF writes the default also for these, so that bounds of 0 come into being. What is left out is not stated for any reader.
    """
    return fact.required or fact.name in _NUMBERS.get(class_name, ())


def reference_texts(feature: FeaturePlan, value: str, most: int = -1) -> list[str]:
    """The ids in an attribute, about as many as are needed at most. A single reference is one id, even with unencoded blanks in it."""
    return value.split(None, most) if feature.many or not value.strip() else [value.strip()]


class ClassPlan:
    """One class in one version.

    Attributes
    ----------
    features : every stored feature in the order of serialisation
    attributes : by XML name, features that may be XML attributes: values and references
    children : by XML name, features that may be child elements: parts, and references as `href`
    wave : that in which the names of objects are known; None if nothing refers to them
    """

    __slots__ = ("attributes", "children", "cls", "features", "referable", "wave")

    def __init__(self, class_name: str, declared: VersionFacts) -> None:
        self.cls: type[Element] = getattr(classes, class_name)
        held = {feature.xml_name: feature for feature in features_of(self.cls).values()}
        self.features = tuple(
            FeaturePlan(held[fact.name].name, held[fact.name].many, fact, declared, class_name)
            for fact in declared.features(class_name)
            if fact.stored
        )
        self.attributes = {f.xml_name: f for f in self.features if f.data_type or f.is_reference}
        self.children = {f.xml_name: f for f in self.features if not f.data_type}
        self.referable = self.cls.is_referable
        self.wave = wave_of(self.cls) if self.referable else None


class Plans:
    """The class plans of one version, made on demand."""

    def __init__(self, version: str) -> None:
        self.facts = facts(version)
        self._plans: dict[str, ClassPlan] = {}

    def of(self, class_name: str) -> ClassPlan | None:
        """The plan of a class that can have objects in this version, else None."""
        plan = self._plans.get(class_name)
        if plan is None:
            fact = self.facts.classes.get(class_name)
            if fact is None or fact.abstract:
                return None
            plan = self._plans[class_name] = ClassPlan(class_name, self.facts)
        return plan

    def part(self, feature: FeaturePlan, xsi_type: str | None) -> ClassPlan | None:
        """The plan of an object in a containment; None if its class (without `xsi:type` the declared one) is not allowed there."""
        name = feature.target.__name__
        if xsi_type is not None:
            prefix, mark, name = xsi_type.partition(":")
            if prefix + mark != TYPE_PREFIX:
                return None
        plan = self.of(name)
        if plan is None or feature.target.__name__ not in self.facts.supertypes(name):
            return None
        feature.parts[xsi_type] = plan
        return plan


@cache
def plans(version: str) -> Plans:
    """The plans of a version with facts."""
    return Plans(version)
