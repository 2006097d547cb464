"""What is about to be written, read again and compared with the document, so that no file is written that means something else.

The text is parsed once more and compared element by element while it is parsed; no second model is made. Of an untouched object,
whose text is copied with everything in it, a mark is read instead: that text was read before, and gave this object.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, NoReturn
from xml.parsers import expat

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.element import Element, extras_if_any
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.naming import place
from amalthea_uros.xmi.emf import problems
from amalthea_uros.xmi.emf.header import ModelHeader, NotAModel, read_header
from amalthea_uros.xmi.emf.plan import TYPE_PREFIX, ClassPlan, FeaturePlan
from amalthea_uros.xmi.emf.serializer import EmfSerializer, tag_of
from amalthea_uros.xmi.emf.source_merger import SourceMerger

_HELP = (
    "Remove what amuros does not know of this object, or what is given twice. If there is nothing like that, this is an error in "
    "amuros: report it together with the file."
)
#: The attribute of the mark that stands for a copied object, with its number; no file has this prefix.
_MARK = "amuros-copy:number"
_NAME = re.compile(r"<([^\s/>]+)")


class _OpenElement(NamedTuple):
    """An open element.

    Attributes
    ----------
    element, plan : the object; None for a reference
    read : the number of values that were read as child elements, by XML name
    attributes : the XML names of the references that were read as attributes
    """

    element: Element | None
    plan: ClassPlan | None
    read: dict[str, int]
    attributes: frozenset[str]


def check_read_back(
    parts: Sequence[str],
    copied: Mapping[int, list[Element]],
    document: Document,
    serializer: EmfSerializer,
    merger: SourceMerger | None,
) -> None:
    """Compare a text with the document that it is to represent.

    Parameters
    ----------
    parts : of the text
    copied : the untouched objects whose text is copied with everything in it, by the numbers of the parts

    Raises
    ------
    WriteError : reading the text would not give the same model.
    """
    comparison = _ReadBackComparison(document, serializer, merger, copied)
    is_declared = any("xmlns:xsi" in part for part in parts)
    if not is_declared and problems.lacks_namespace("".join(parts).encode()):
        comparison.refuse(document.root, "the prefix 'xsi' would not be declared")
    text = "".join([comparison.mark(number, part) if number in copied else part for number, part in enumerate(parts)])
    parser = comparison.parser
    parser.StartElementHandler, parser.EndElementHandler = comparison.start, comparison.end
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        open_element = next((level.element for level in reversed(comparison.stack) if level.element is not None), document.root)
        comparison.refuse(open_element, f"the text would not be well-formed XML ({expat.ErrorString(error.code)})")
    finally:
        parser.StartElementHandler = parser.EndElementHandler = None


class _ReadBackComparison:
    def __init__(
        self, document: Document, serializer: EmfSerializer, merger: SourceMerger | None, copied: Mapping[int, list[Element]]
    ) -> None:
        self.document = document
        self.copied = {str(number): elements for number, elements in copied.items()}
        self.serializer = serializer
        self.merger = merger
        self.parser = expat.ParserCreate()
        self.header: ModelHeader | None = None
        self.stack: list[_OpenElement] = []
        self.skipped_depth = 0

    def mark(self, number: int, piece: str) -> str:
        """The object that is read instead of copied ones."""
        elements = self.copied[str(number)]
        name, last = _NAME.match(piece), piece.rfind("<")
        last_name = _NAME.match(piece, last) if last == 0 or len(elements) > 1 else None
        is_empty = piece.endswith("/>") and name is not None and last_name is not None and last_name[1] == name[1]
        if name is None or not (is_empty or re.fullmatch(rf"</{re.escape(name[1])}\s*>", piece[last:])):
            self.refuse(elements[0], "its text would not be one element")
        return f'{name[0]} {_MARK}="{number}"/>'

    # Events

    def start(self, name: str, attributes: dict[str, str]) -> None:
        if self.skipped_depth:
            self.skipped_depth += 1
        elif self.header is None:
            self.start_root(name, attributes)
        else:
            parent = self.stack[-1]
            feature = parent.plan.children.get(name) if parent.plan else None
            if feature is None or parent.element is None or not self.start_known(parent, parent.element, feature, attributes):
                self.skipped_depth = 1
                parent.read[""] = parent.read.get("", 0) + 1

    def end(self, _name: str) -> None:
        if self.skipped_depth:
            self.skipped_depth -= 1
            return
        element, plan, read, _ = self.stack.pop()
        if element is None or plan is None:
            return
        for child in self.serializer.write_plan(plan, element).children:
            if not child.is_reference and read.get(child.xml_name, 0) != len(_values(element, child)):
                self.refuse(element, f"{child.xml_name!r} would be incomplete")
        extras = extras_if_any(element)
        kept = sum(bool(tag_of(raw)) for _, raw in extras.content) if extras else 0
        if read.get("", 0) != kept:
            self.refuse(element, f"{read.get('', 0)} unknown elements would be read instead of {kept}")

    # Comparison

    def start_root(self, name: str, attributes: dict[str, str]) -> None:
        root = self.document.root
        header = read_header(name, attributes)
        if isinstance(header, NotAModel):
            self.refuse(root, header.message)
        self.header = header
        if header.facts_version != self.document.facts_version:
            self.refuse(root, f"the version would be {header.version}")
        plan = self.serializer.plans.of("Amalthea")
        extras = extras_if_any(root)
        if {key: attributes[key] for key in attributes.keys() - header.own_attributes} != (extras.attributes if extras else {}):
            self.refuse(root, "its unknown attributes would change")
        self.stack.append(_OpenElement(root, plan, {}, frozenset()))

    def start_known(self, parent: _OpenElement, holder: Element, feature: FeaturePlan, attributes: dict[str, str]) -> bool:
        """Compare a child element that the metamodel knows; whether the reader would use it."""
        assert self.header
        name = feature.xml_name
        type_name = attributes.pop(self.header.xsi_type, None)
        number, count = parent.read.get(name, 0), 1
        is_surplus = number > 0 and (not feature.many or feature.only_one)
        if feature.is_reference:
            if list(attributes) != ["href"] or is_surplus or name in parent.attributes:
                return False
            self.compare_href(holder, feature, number, attributes["href"])
            self.stack.append(_OpenElement(None, None, {}, frozenset()))
        else:
            if type_name is not None and self.header.type_prefix != TYPE_PREFIX:
                type_name = TYPE_PREFIX + type_name.removeprefix(self.header.type_prefix)
            values = _values(holder, feature)
            copied = self.copied.get(attributes.get(_MARK, ""))
            plan = feature.parts.get(type_name) or self.serializer.plans.part(feature, type_name)
            if is_surplus or (plan is None and copied is None):
                return False
            value = values[number] if number < len(values) else None
            if copied is not None and values[number : number + len(copied)] == copied:
                count = len(copied)
                self.stack.append(_OpenElement(None, None, {}, frozenset()))
            elif copied is None and plan is not None and type(value) is plan.cls:
                self.start_part(value, feature, plan, attributes)
            else:
                self.refuse(holder, f"{name!r} would be another object")
        parent.read[name] = number + count
        return True

    def start_part(self, element: Element, feature: FeaturePlan, plan: ClassPlan, attributes: dict[str, str]) -> None:
        wanted = self.serializer.attributes(feature, plan, element, self.serializer.write_plan(plan, element))
        wanted.pop(self.serializer.prefixes.xsi_type, None)
        if attributes != wanted:
            for key, value in attributes.items():
                if wanted.get(key) != value and not self.is_meant(element, plan, key, value, wanted.get(key)):
                    self.refuse(element, f"the attribute {key!r} would be {value!r}")
            for key in wanted.keys() - attributes.keys():
                known = plan.attributes.get(key)
                if known is not None and element.__dict__.get(known.name) is not None:
                    self.refuse(element, f"the attribute {key!r} would be missing")
        self.stack.append(_OpenElement(element, plan, {}, frozenset(attributes)))

    def is_meant(self, element: Element, plan: ClassPlan, key: str, value: str, wanted: str | None) -> bool:
        """Whether an attribute that EMF would not write like this has the value of the object, or is unknown content."""
        extras = extras_if_any(element)
        if extras and extras.attributes.get(key) == value:
            return True
        return self.merger is not None and self.merger.is_unchanged(element, plan, key, value, wanted)

    def compare_href(self, holder: Element, feature: FeaturePlan, number: int, href: str) -> None:
        values = _values(holder, feature)
        text = href.partition("#")[2] or href
        if self.merger is not None:
            (text,) = self.merger.canonical_references(holder, feature.xml_name, [text])
        if number >= len(values) or self.serializer.target(values[number])[0] != text:
            self.refuse(holder, f"{feature.xml_name!r} would refer to {text!r}")

    def refuse(self, element: Element, reason: str) -> NoReturn:
        name = place(element)
        message = f"{name}: the file would be read differently: {reason}"
        raise WriteError(
            [Finding("XMI106", Severity.ERROR, message, self.document.location_of(element), _HELP, name)]
        ) from None


def _values(element: Element, feature: FeaturePlan) -> list[Any]:
    """What an object has of a feature, as a list."""
    value = element.__dict__.get(feature.name)
    return value if isinstance(value, list) else [] if value is None else [value]
