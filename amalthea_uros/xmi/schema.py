"""Validation of a file against the XML schema of its AMALTHEA version, with readable problems."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache, partial
from typing import TYPE_CHECKING, cast

from lxml import etree

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.resources import resource_folder
from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import UnknownError
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.versions import NAMESPACE_PREFIX, VersionFacts, facts, spelled, supported_versions

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    import xmlschema

    from amalthea_uros.metamodel.factfile import FeatureFact


#: Further problems are only counted.
MAX_PROBLEMS = 100

#: No class has so many attributes; for each error in some, xmlschema formats all attributes of the element.
_MANY_ATTRIBUTES = 100

#: A reason and advice, and the element concerned; texts and paths are made only for the problems that are reported.
_Text = tuple[str, str | None]
_Finding = tuple[etree._Element, Callable[[], _Text]]

_XSI = "{http://www.w3.org/2001/XMLSchema-instance}"
_XMI = "{http://www.omg.org/XMI}"
_LOCATIONS = (f"{_XSI}schemaLocation", f"{_XSI}noNamespaceSchemaLocation")

#: Fragments of messages of xmlschema by which a kind of error is recognised.
_CANNOT_SUBSTITUTE = "cannot substitute"
_IS_ABSTRACT = "is abstract"

_WHOLE_NUMBERS = {
    "EInt": "a whole number of 32 bits",
    "EIntegerObject": "a whole number of 32 bits",
    "ELong": "a whole number of 64 bits",
    "ELongObject": "a whole number of 64 bits",
    "EBigInteger": "a whole number",
}


@dataclass(frozen=True, slots=True)
class SchemaProblem:
    """A violation of the schema of a version.

    Attributes
    ----------
    line : line of the start tag, or of the end of what could be parsed
    column : known only where the file is not well-formed
    path : XPath of the element, such as "/am:Amalthea/swModel/tasks[2]"
    reason : what is wrong
    advice : what would be allowed
    """

    line: int
    column: int | None
    path: str
    reason: str
    advice: str | None = None


def schema_path(version: str) -> Path:
    """The schema file of an AMALTHEA version.

    Raises
    ------
    UnknownError : if there is none.
    """
    if version not in supported_versions():
        others = ", ".join(supported_versions())
        raise UnknownError(f"no XML schema for {spelled(version)}; there is one for {others}")
    return resource_folder("schemas") / f"amalthea-{version}.xsd"


def validate(data: bytes, version: str) -> list[SchemaProblem]:
    """All violations of the schema of a version in the text of a file, in the order of the lines.

    Raises
    ------
    UnknownError : if there is no schema of the version.
    """
    schema = _schema(version)
    try:
        root, is_valid = _parsed(data, schema)
    except etree.XMLSyntaxError as error:
        line, column = error.position
        return [SchemaProblem(line, column, "/", "not well-formed XML: " + error.msg.split(", line ")[0])]
    if entities := list(_entities(root)):
        return _sorted_problems(entities)
    if is_valid:
        return []
    _drop_locations(root)
    return _sorted_problems(_Diagnosis(root, facts(version)).findings()) or _plain(root, schema)


def _parsed(data: bytes, schema: etree.XMLSchema) -> tuple[etree._Element, bool]:
    """The tree of a file, and whether it is valid.

    It is validated while it is parsed: of a whole tree, lxml makes a path for each error, and counts all siblings for it.
    """
    parser = partial(etree.XMLParser, resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
    try:
        return etree.fromstring(data, parser(schema=schema)), True
    except etree.XMLSyntaxError:
        return etree.fromstring(data, parser()), False


@cache
def _schema(version: str) -> etree.XMLSchema:
    return etree.XMLSchema(file=str(schema_path(version)))


@cache
def _diagnosing_schema(version: str) -> xmlschema.XMLSchema10:
    import xmlschema  # slow to import, and needed for invalid files only

    return xmlschema.XMLSchema10(str(schema_path(version)), allow="local")


def _sorted_problems(findings: list[_Finding]) -> list[SchemaProblem]:
    """The problems by line; those at the end of a long list are only counted."""
    findings.sort(key=lambda finding: cast("int", finding[0].sourceline))
    problems = [_at(element, *words()) for element, words in findings[:MAX_PROBLEMS]]
    more = findings[MAX_PROBLEMS:]
    return (
        [*problems, _at(more[0][0], f"{len(more)} more problem{'s' if len(more) > 1 else ''} from here on, not listed")]
        if more
        else problems
    )


def _at(element: etree._Element, reason: str, advice: str | None = None) -> SchemaProblem:
    line = cast("int", element.sourceline)
    return SchemaProblem(line, None, element.getroottree().getpath(element), reason, advice)


def _entities(root: etree._Element) -> Iterator[_Finding]:
    """Entity references between the elements: they are not replaced, and no validator sees through them."""
    for entity in root.iter(etree.Entity):
        yield cast("etree._Element", entity.getparent()), partial(_unreplaced, entity)


def _unreplaced(entity: etree._Element) -> _Text:
    return f"entity reference {entity.text} between the elements", "remove it"


def _drop_locations(root: etree._Element) -> None:
    """Prevent the validators from loading the schema that the file names."""
    for element in root.iter("*"):
        for name in _LOCATIONS:
            if name in element.attrib:
                del element.attrib[name]


def _plain(root: etree._Element, schema: etree.XMLSchema) -> list[SchemaProblem]:
    """The problems in the words of the validator."""
    schema.validate(root)
    errors = cast("Iterable[etree._LogEntry]", schema.error_log)
    return [SchemaProblem(e.line, None, e.path or "/", re.sub(r"\{.*?\}", "", e.message)) for e in errors]


def _quoted(names: Sequence[str]) -> str:
    return ", ".join(f'"{name}"' for name in names)


def _nearest(name: str, allowed: Sequence[str]) -> str | None:
    """Advice: the most similar name, or all that are allowed."""
    close = similar(name, allowed)
    if close:
        return f'did you mean "{close[0]}"?'
    return f"allowed: {_quoted(sorted(allowed))}" if allowed else None


def _is_of_class(error: xmlschema.XMLSchemaValidationError) -> bool:
    """Whether the class of an element is wrong or missing."""
    reason = error.reason or ""
    return _CANNOT_SUBSTITUTE in reason or reason.endswith(_IS_ABSTRACT)


def _repeats(error: xmlschema.XMLSchemaValidationError) -> bool:
    """Whether the error repeats that of a faulty child for its parent."""
    from xmlschema.validators import XsdGroup

    return _CANNOT_SUBSTITUTE in (error.reason or "") and isinstance(error.validator, XsdGroup)


class _Diagnosis:
    """Finds the problems of an invalid file one by one and describes them in the terms of AMALTHEA."""

    def __init__(self, root: etree._Element, declared: VersionFacts) -> None:
        self.root = root
        self.declared = declared
        #: Elements of an unknown or wrong class: their attributes and content cannot be checked.
        self.opaque: set[etree._Element] = set()

    def findings(self) -> list[_Finding]:
        """All problems found, in no particular order; none if only the schema validator sees them."""
        if self.root.tag != f"{{{self.declared.namespace}}}Amalthea":
            return [(self.root, self._wrong_root)]
        found = list(self._unknown_classes())
        surplus = list(self._surplus_attributes())
        for error in _diagnosing_schema(self.declared.version).iter_errors(self.root):
            element = cast("etree._Element", error.invalid_child if error.invalid_tag else error.elem)
            if not self._hidden(element) and not _repeats(error):
                found.append((element, partial(self._text, element, error)))
                if _is_of_class(error):
                    self.opaque.add(element)
        return found + [(element, words) for element, words in surplus if not self._hidden(element)]

    def _hidden(self, element: etree._Element) -> bool:
        return bool(self.opaque) and (element in self.opaque or any(e in self.opaque for e in element.iterancestors()))

    def _wrong_root(self) -> _Text:
        name = etree.QName(self.root)
        if name.namespace == self.declared.namespace:
            return f'wrong root element "{name.localname}"', 'expected: "Amalthea"'
        other = (name.namespace or "").removeprefix(NAMESPACE_PREFIX)
        advice = (
            f"validate it as AMALTHEA {other}" if other in supported_versions() else f'expected: "{self.declared.namespace}"'
        )
        return f'wrong namespace of the root element: "{name.namespace or ""}"', advice

    def _unknown_classes(self) -> Iterator[_Finding]:
        """Elements of a class that does not exist or is abstract; their `xsi:type` is removed."""
        for element in self.root.iter("*"):
            text = element.get(f"{_XSI}type")
            if text is None:
                continue
            prefix, _, name = text.strip().rpartition(":")
            fact = self.declared.classes.get(name)
            if fact is not None and not fact.abstract and element.nsmap.get(prefix or None) == self.declared.namespace:
                continue
            what = "an abstract class" if fact and fact.abstract else f"not a class of AMALTHEA {self.declared.version}"
            yield element, partial(self._unknown_class, element, name, f'xsi:type="{text}" is {what}')
            del element.attrib[f"{_XSI}type"]
            self.opaque.add(element)

    def _unknown_class(self, element: etree._Element, name: str, reason: str) -> _Text:
        return reason, self._class_advice(element, name)

    def _surplus_attributes(self) -> Iterator[_Finding]:
        """The unknown ones of a great many attributes of an element; they are removed."""
        for element in self.root.iter("*"):
            if len(element.attrib) <= _MANY_ATTRIBUTES:
                continue
            known = {*self._names(self._class_of(element), FeatureKind.ATTRIBUTE, FeatureKind.REFERENCE)}
            is_known = element is self.root or self._feature(element) is not None
            for name in map(str, element.attrib):
                if name in known or name.startswith((_XMI, _XSI)):
                    continue
                del element.attrib[name]
                if is_known:
                    yield element, partial(self._unknown_attribute, element, name)

    def _class_advice(self, element: etree._Element, name: str) -> str | None:
        expected = self._declared_class(element)
        if not expected:
            return None
        prefix = self.root.prefix or "am"
        return _nearest(f"{prefix}:{name}", [f"{prefix}:{c}" for c in self.declared.concrete_subtypes(expected)])

    def _feature(self, element: etree._Element) -> FeatureFact | None:
        """The feature that an element belongs to."""
        parent = element.getparent()
        owner = self._class_of(parent) if parent is not None else None
        return self.declared.feature(owner, element.tag) if owner else None

    def _declared_class(self, element: etree._Element) -> str:
        """The class that the feature of an element declares, "" where there is no such feature."""
        feature = self._feature(element)
        return feature.type if feature else ""

    def _class_of(self, element: etree._Element) -> str | None:
        """The class of an element, None for a bare reference."""
        if element is self.root:
            return "Amalthea"
        text = element.get(f"{_XSI}type")
        if text:
            return text.strip().rpartition(":")[2]
        feature = self._feature(element)
        return feature.type if feature and feature.kind is FeatureKind.CONTAINMENT else None

    def _names(self, class_name: str | None, *kinds: FeatureKind) -> list[str]:
        """The names of the features of a class, or of a bare reference."""
        if class_name is None:
            return ["href"] if FeatureKind.ATTRIBUTE in kinds else []
        return [f.name for f in self.declared.features(class_name) if f.stored and f.kind in kinds]

    def _text(self, element: etree._Element, error: xmlschema.XMLSchemaValidationError) -> _Text:
        reason = error.reason or ""
        if error.invalid_tag:
            return self._unknown_child(element)
        if _CANNOT_SUBSTITUTE in reason:
            return self._wrong_class(element)
        if reason.endswith(_IS_ABSTRACT):
            return self._missing_class(element)
        if match := re.match(r"'(.*)' attribute not allowed", reason):
            return self._unknown_attribute(element, match[1])
        if match := re.match(r"attribute (\S+?)=['\"]", reason):
            return self._wrong_value(element, match[1])
        if reason.startswith("character data"):
            return "text between the elements", "remove it"
        return reason, None

    def _unknown_child(self, element: etree._Element) -> _Text:
        owner = self._class_of(cast("etree._Element", element.getparent()))
        name = etree.QName(element).localname
        written = f"{element.prefix}:{name}" if element.prefix else name
        advice = _nearest(name, self._names(owner, FeatureKind.CONTAINMENT, FeatureKind.REFERENCE))
        return f'{owner or "a reference"} has no element "{written}"', advice

    def _unknown_attribute(self, element: etree._Element, name: str) -> _Text:
        owner = self._class_of(element)
        advice = _nearest(name, self._names(owner, FeatureKind.ATTRIBUTE, FeatureKind.REFERENCE))
        return f'{owner or "a reference"} has no attribute "{name.replace(_XMI, "xmi:")}"', advice

    def _wrong_class(self, element: etree._Element) -> _Text:
        name = self._class_of(element) or ""
        reason = f'wrong xsi:type {name}: "{element.tag}" contains objects of class {self._declared_class(element)}'
        return reason, self._class_advice(element, name)

    def _missing_class(self, element: etree._Element) -> _Text:
        reason = f"missing xsi:type: {self._declared_class(element)} is an abstract class"
        return reason, self._class_advice(element, "")

    def _wrong_value(self, element: etree._Element, name: str) -> _Text:
        value = element.get(name)
        feature = self.declared.feature(self._class_of(element) or "", name)
        what, advice = self._value_advice(feature.type if feature else "")
        return f'attribute {name}="{value}" is not {what}', advice

    def _value_advice(self, type_name: str) -> tuple[str, str | None]:
        """What a value of a type must be, and advice on the allowed values."""
        if type_name in self.declared.enums:
            return f"a literal of {type_name}", f"allowed: {_quoted(self.declared.enums[type_name].literals)}"
        if type_name == "EBoolean":
            return "a boolean", 'allowed: "true", "false"'
        if type_name == "Address":
            return "an address", 'allowed: hexadecimal numbers such as "0x1a" and decimal numbers such as "26"'
        if type_name in _WHOLE_NUMBERS:
            return _WHOLE_NUMBERS[type_name], None
        number = self.declared.numbers.get(type_name)
        if number is None:
            return "a number", None
        kind = "number" if number.java_type == "double" else "whole number"
        return f"a {kind} {'greater than' if number.exclusive else 'of at least'} {number.minimum}", None


def schema_findings(document: Document) -> list[Finding]:
    """The violations of the XML schema of its version in a file; none if the document has no file."""
    source, path = document.source, document.path
    if source is None or path is None:
        return []
    try:
        # The file of a model that was migrated in memory still has its old version.
        problems = validate(source.text.encode(), document.file_version)
    except UnknownError as error:
        return [Finding("XSD000", Severity.WARNING, str(error), Location(path))]
    return [
        Finding(
            "XSD001",
            Severity.ERROR,
            problem.reason,
            Location(path, problem.line, problem.column, source.line(problem.line)),
            problem.advice or "",
            problem.path,
        )
        for problem in problems
    ]
