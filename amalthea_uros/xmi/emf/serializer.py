"""What EMF would write for an object: its attributes and children, in order.

Values are checked at the same time; what the metamodel of the version does not allow becomes a finding that names the object.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.naming import place, unique_name
from amalthea_uros.metamodel.source import Prefixes
from amalthea_uros.xmi.emf.escape import escape, impossible_character
from amalthea_uros.xmi.emf.plan import ClassPlan, FeaturePlan, plans


class ChildPart(NamedTuple):
    """A child element that holds an object."""

    feature: FeaturePlan
    element: Element


class ChildReference(NamedTuple):
    """A child element that refers to an object of another file.

    Attributes
    ----------
    reference : the id after `amlt:/#`
    tag : the whole element as text
    """

    feature: FeaturePlan
    reference: str
    tag: str


Child = ChildPart | ChildReference


class WritePlan(NamedTuple):
    """The features to write for objects of one class that have the same features set.

    Attributes
    ----------
    attributes : features with whether they are set
    children : features that may be written as child elements
    """

    attributes: tuple[tuple[FeaturePlan, bool], ...]
    children: tuple[FeaturePlan, ...]
    has_extras: bool


class EmfSerializer:
    """Serialises the objects of one document."""

    def __init__(self, document: Document, prefixes: Prefixes) -> None:
        self.document = document
        self.plans = plans(document.facts_version)
        self.prefixes = prefixes
        self.findings: list[Finding] = []
        self.uses_xsi = False
        #: Unknown content that was written, which may need namespaces of the file.
        self.kept: list[str] = []
        self._write_plans: dict[tuple[type[Element], tuple[str, ...]], WritePlan] = {}
        #: Reference text of a target, and whether it is in this document.
        self._targets: dict[Element, tuple[str, bool]] = {}

    def plan(self, element: Element) -> ClassPlan | None:
        """How the object is written; None, with a finding, if the version has no such class."""
        plan = self.plans.of(type(element).__name__)
        if plan is None:
            kind = "is abstract" if type(element).is_abstract else "does not exist"
            self.refuse(element, f"the class {type(element).__name__} {kind} in AMALTHEA {self.document.facts_version}")
        return plan

    def write_plan(self, plan: ClassPlan, element: Element) -> WritePlan:
        """The features to write for the object."""
        present = tuple(element.__dict__)
        write_plan = self._write_plans.get((plan.cls, present))
        if write_plan is None:
            write_plan = self._write_plans[plan.cls, present] = self._new_write_plan(plan, element)
        return write_plan

    def _new_write_plan(self, plan: ClassPlan, element: Element) -> WritePlan:
        present = element.__dict__
        unknown = present.keys() - {feature.name for feature in plan.features} - {"_extras"}
        for name in sorted(unknown):
            if present[name] not in (None, []):
                version = self.document.facts_version
                self.refuse(element, f"{type(element).__name__} has no feature {name!r} in AMALTHEA {version}")
        attributes = []
        for feature in plan.features:
            is_set = feature.name in present
            if feature.xml_name in plan.attributes and (is_set or feature.default_text is not None):
                attributes.append((feature, is_set))
        children = tuple(f for f in plan.features if f.xml_name in plan.children and f.name in present)
        # A plan with features unknown to the version is not shared, so that every object with one is reported.
        write_plan = WritePlan(tuple(attributes), children, "_extras" in present)
        if unknown:
            self._write_plans.pop((plan.cls, tuple(present)), None)
        return write_plan

    # Attributes

    def attributes(self, part: FeaturePlan | None, plan: ClassPlan, element: Element, write_plan: WritePlan) -> dict[str, str]:
        """The attributes as EMF writes them, not yet escaped."""
        found = {}
        if part is not None and plan.cls is not part.target:
            self.uses_xsi = True
            found[self.prefixes.xsi_type] = f"{self.prefixes.type_prefix}{plan.cls.__name__}"
        if plan.referable:
            found[self.prefixes.xmi_id] = self.target(element)[0]
        values = element.__dict__
        for feature, is_set in write_plan.attributes:
            value = values[feature.name] if is_set else None
            text = feature.default_text if value is None else self.value_text(element, feature, value)
            if text is not None:
                found[feature.xml_name] = text
        return found

    def value_text(self, element: Element, feature: FeaturePlan, value: Any) -> str | None:
        """A set value as text; None if it is not written as an attribute."""
        if feature.is_reference:
            return self.reference_text(element, feature, value)
        data_type = feature.data_type
        assert data_type
        if type(value) is not data_type.python_type:
            checked = _converted(value, data_type.python_type)
            if checked is None:
                expected = data_type.python_type.__name__
                self.refuse(element, f"{feature.name!r} must be of type {expected}, not {value!r}")
                return None
            value = checked
        if feature.is_string:
            wrong = impossible_character(value)
            if wrong is not None:
                self.refuse(element, f"{feature.name!r} contains the character U+{ord(wrong):04X}, which XML does not allow")
                return None
            return str(value)
        if value == feature.omitted:
            return None
        try:
            text: str = data_type.format(value)
            data_type.parse(text)
        except ValueError as error:
            self.refuse(element, f"{feature.name!r}: {error}")
            return None
        return text

    def reference_text(self, element: Element, feature: FeaturePlan, value: Any) -> str | None:
        """The ids of the targets, None if they are written as `href` elements (or there are none)."""
        if not feature.many:
            if not isinstance(value, feature.target):
                self.refuse_target(element, feature, value)
                return None
            text, is_local = self.target(value)
            return text if self.is_attribute(element, feature, is_local) else None
        targets = self.checked_targets(element, feature, value)
        if not targets:
            return None
        is_local = all(self.target(target)[1] for target in targets)
        if not self.is_attribute(element, feature, is_local):
            return None
        return " ".join([self.target(target)[0] for target in targets])

    def is_attribute(self, element: Element, feature: FeaturePlan, is_local: bool) -> bool:
        """Whether a reference is written as an attribute: as it was read, or else if all its targets are in this file."""
        forms = self.document.href_features
        if forms:
            is_href = forms.get((element, feature.xml_name))
            if is_href is not None:
                return not is_href
        return is_local

    def checked_targets(self, element: Element, feature: FeaturePlan, value: Any) -> list[Element]:
        """The targets of the right class; the others become findings."""
        if not isinstance(value, list):
            self.refuse_target(element, feature, value)
            return []
        fitting = [target for target in value if isinstance(target, feature.target)]
        for target in value:
            if not isinstance(target, feature.target):
                self.refuse_target(element, feature, target)
        return fitting

    def target(self, element: Element) -> tuple[str, bool]:
        """The reference text of an object and whether it is in this document."""
        found = self._targets.get(element)
        if found is None:
            document = element.document
            found = self._targets[element] = (unique_name(element), document is self.document)
            if document is None and element.unresolved is None:
                self.findings.append(
                    self.finding(
                        element,
                        f"{element!r} is referenced, but not part of the model",
                        "Add it to the model, or remove the references to it.",
                    )
                )
        return found

    # Children

    def children(self, element: Element, write_plan: WritePlan) -> list[Child]:
        """The child elements in order."""
        found: list[Child] = []
        values = element.__dict__
        for feature in write_plan.children:
            value = values[feature.name]
            if value is None:
                continue
            if feature.is_reference:
                found += self.hrefs(element, feature, value)
            elif feature.many:
                if feature.only_one and len(value) > 1:
                    self.refuse(element, f"{feature.name!r} can have only one object in AMALTHEA {self.document.facts_version}")
                found += [ChildPart(feature, part) for part in value if self.check_part(element, feature, part)]
            elif self.check_part(element, feature, value):
                found.append(ChildPart(feature, value))
        return found

    def hrefs(self, element: Element, feature: FeaturePlan, value: Any) -> list[Child]:
        """The `href` elements of a reference, none if it is written as an attribute."""
        targets = [t for t in (value if isinstance(value, list) else [value]) if isinstance(t, feature.target)]
        is_local = all(self.target(target)[1] for target in targets)
        if self.is_attribute(element, feature, is_local):
            return []
        found: list[Child] = [self.href(feature, target) for target in targets]
        if self.document.href_content:
            self.fill(element, feature, targets, found)
        return found

    def fill(self, element: Element, feature: FeaturePlan, targets: list[Element], hrefs: list[Child]) -> None:
        """Put into `href` elements what is inside them in the file."""
        first_numbers = {target: number for number, target in reversed(list(enumerate(targets)))}
        for target, number in first_numbers.items():
            content = self.document.href_content.get((element, feature.xml_name, target))
            href = hrefs[number]
            if content and isinstance(href, ChildReference):
                self.kept += content
                hrefs[number] = href._replace(tag=f"{href.tag[:-2]}>{''.join(content)}</{feature.xml_name}>")

    def href(self, feature: FeaturePlan, target: Element) -> ChildReference:
        """`<task href="amlt:/#T?type=Task"/>`, with `xsi:type` where the declared class is abstract."""
        text = self.target(target)[0]
        typed = ""
        if feature.target_is_abstract:
            self.uses_xsi = True
            typed = f' {self.prefixes.xsi_type}="{self.prefixes.type_prefix}{type(target).__name__}"'
        return ChildReference(feature, text, f'<{feature.xml_name}{typed} href="amlt:/#{escape(text)}"/>')

    def check_part(self, element: Element, feature: FeaturePlan, part: Any) -> bool:
        """Whether an object may be a part of another one; if not, a finding says so."""
        if isinstance(part, feature.target):
            return True
        self.refuse_target(element, feature, part)
        return False

    # Findings

    def refuse_target(self, element: Element, feature: FeaturePlan, value: object) -> None:
        """Add a finding about a value of the wrong class."""
        expected = (
            f"a list of {feature.target.__name__}"
            if feature.many and not isinstance(value, Element)
            else feature.target.__name__
        )
        self.refuse(element, f"{feature.name!r} must be {expected}, not {value!r}")

    def refuse(self, element: Element, message: str) -> None:
        """Add a finding about an object."""
        self.findings.append(self.finding(element, message, ""))

    def finding(self, element: Element, message: str, help_text: str) -> Finding:
        """A finding that names the object."""
        name = place(element)
        return Finding("XMI100", Severity.ERROR, f"{name}: {message}", self.document.location_of(element), help_text, name)


def _converted(value: object, expected: type) -> Any:
    """The value as one of the expected type, where that is possible: whole numbers as floating point; else None."""
    if expected is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if isinstance(value, expected) and not isinstance(value, bool):
        return value
    return None


# Unknown content of a file when it is written again: where it goes, and which namespaces it needs

_TAG = re.compile(r"<([^\s/>!?]+)")
#: Prefixes of elements and attributes, and of names in values such as that of `xsi:type`.
_PREFIX = re.compile(r"(?<![\w.:-])([\w.-]+):(?=\w)")


class KeptContent(NamedTuple):
    """The unknown content of one element among its children.

    Attributes
    ----------
    before : what comes before a part (None: at the end)
    after : what comes after the child of a feature
    """

    before: dict[Element | None, list[str]]
    after: dict[str, list[str]]

    @classmethod
    def of(cls, content: Sequence[tuple[Element | None, str]], children: Sequence[Child]) -> KeptContent:
        """The places of the content. Where only one value is allowed, readers use the first; further ones stay after it."""
        before: dict[Element | None, list[str]] = {}
        after: dict[str, list[str]] = {}
        if content:
            parts = {child.element for child in children if isinstance(child, ChildPart)}
            single = {child.feature.xml_name for child in children if not child.feature.many or child.feature.only_one}
            for anchor, raw in content:
                tag = tag_of(raw)
                if tag in single:
                    after.setdefault(tag, []).append(raw)
                else:
                    before.setdefault(anchor if anchor in parts else None, []).append(raw)
        return cls(before, after)


def tag_of(raw: str) -> str:
    """The name of an unknown element, "" for anything else."""
    found = _TAG.match(raw)
    return found[1] if found else ""


def used_prefixes(kept: Iterable[str]) -> set[str]:
    """The prefixes that unknown content may need."""
    return {prefix for raw in kept if ":" in raw and not raw.startswith(("<!", "<?")) for prefix in _PREFIX.findall(raw)}
