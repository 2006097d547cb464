"""Text of one file -> document: objects, and the references that are still to be resolved.

The parser is expat, driven in one pass. Line and column of all objects can be found at any time, also of attributes, and beyond line
65,535, where libxml2 stops counting: the order of the objects is that of the start tags in the text.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, Protocol
from xml.parsers import expat

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.containment import ContainmentList
from amalthea_uros.metamodel.element import Element, extras_of, set_container
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.source import FileText, Prefixes, SourceText
from amalthea_uros.xmi.emf import problems
from amalthea_uros.xmi.emf.escape import WHITE_SPACE, escape_text
from amalthea_uros.xmi.emf.handlers import connect, disconnect
from amalthea_uros.xmi.emf.header import XSI_NAMESPACE, ModelHeader, NotAModel, read_header
from amalthea_uros.xmi.emf.plan import TYPE_PREFIX, ClassPlan, FeaturePlan, plans
from amalthea_uros.xmi.emf.problems import CollectedFinding, FindingCollector

_KEPT = "Unknown content is ignored, but preserved when the file is saved."

# Values go into the instance dictionary of an object and the slot of its container, in half of the time of `object.__setattr__`.
_new = object.__new__
_append = list.append
_new_list = list.__new__

StartHandler = Callable[[str, dict[str, str]], None]
EndHandler = Callable[[str], None]


#: References to be resolved when all documents are read, by feature: the objects that refer. Until then the instance dictionary of such
#: an object has the text of an attribute, or the list of the ids of `href` elements.
PendingReferences = Mapping[FeaturePlan, list[Element]]

#: An open element: its object (None for an `href` element), what was read of it so far (its instance dictionary, with the texts of
#: its references until they are resolved), and its possible child elements. A plain tuple, because one is made for every element.
Frame = tuple[Any, dict[str, Any], dict[str, FeaturePlan]]


class ReadResult(NamedTuple):
    """One file as read.

    Attributes
    ----------
    references, hrefs : references that are stated by attributes, and by `href` elements
    referables : objects that can be referred to, by class
    xmi_ids : the `xmi:id` of every object that has one
    href_content : what is inside an `href` element, by the object that refers, the feature and the number of the element
    href_types : the classes that `href` elements state, by their texts
    findings : problems that did not prevent reading
    """

    document: Document
    references: PendingReferences
    hrefs: PendingReferences
    referables: Mapping[ClassPlan, list[Element]]
    xmi_ids: dict[Element, str]
    href_content: Mapping[tuple[Element, str, int], list[str]]
    href_types: Mapping[str, str]
    findings: list[Finding]


def read(path: Path, content: FileText) -> ReadResult:
    """Read one file.

    Raises
    ------
    ReadError : not XML, not an AMALTHEA model, a version too old, or refused for safety.
    """
    # To intern each name takes longer than to compare it.
    return _finish(_ModelReader(path, content, expat.ParserCreate("utf-8", intern=None)))


class ParserEvents(Protocol):
    """What reports the elements of a model in the way of a parser of expat, such as those of a model that was migrated.

    Attributes
    ----------
    made : the reader puts the objects here when it makes them
    """

    made: list[Element]


def read_events(path: Path, content: FileText, events: ParserEvents) -> ReadResult:
    """Read what something else than a parser reports of a file.

    Raises
    ------
    ReadError : nested too deep.
    """
    reader = _ModelReader(path, content, events)
    events.made = reader.elements
    return _finish(reader)


def _finish(reader: _ModelReader) -> ReadResult:
    try:
        return reader.read()
    finally:
        disconnect(reader.parser)


class _ModelReader:
    def __init__(self, path: Path, content: FileText, parser: Any) -> None:
        self.path = path
        self.content = content
        #: Of expat, or what reports the nodes of a migrated model in the same way.
        self.parser = parser
        self.header: ModelHeader | None = None
        self.elements: list[Element] = []
        self.other_tags: list[int] = []
        #: The open elements; an `href` element has no object of its own.
        self.stack: list[Frame] = []
        self.references: defaultdict[FeaturePlan, list[Element]] = defaultdict(list)
        self.hrefs: defaultdict[FeaturePlan, list[Element]] = defaultdict(list)
        self.referables: defaultdict[ClassPlan, list[Element]] = defaultdict(list)
        self.xmi_ids: dict[Element, str] = {}
        #: Comments and the like, until the part that follows them is read.
        self.pending_extras: dict[Element, list[str]] = {}
        #: The same for what is inside `href` elements, and the key of the last one of these.
        self.href_content: dict[tuple[Element, str, int], list[str]] = {}
        self.href: tuple[Element, str, int] | None = None
        self.href_types: dict[str, str] = {}
        self.prolog: list[str] = []
        self.epilog: list[str] = []
        self.skipped_depth = 0
        self.skipped_start = 0
        self.start_part: StartHandler | None = None
        self.end_part: EndHandler = self.end_handler()
        self.collector = FindingCollector()

    def read(self) -> ReadResult:
        parser = self.parser
        connect(
            parser,
            self.encoded,
            start=self.start_root,
            end=self.end_part,
            characters=self.characters,
            comment=self.comment,
            processing_instruction=self.processing_instruction,
            doctype=self.refuse_doctype,
        )
        try:
            # In UTF-8, whatever the encoding of the file and its declaration: so the offsets count.
            parser.Parse(self.encoded, True)
        except expat.ExpatError as error:
            raise self.malformed(error) from None
        return self.result()

    def result(self) -> ReadResult:
        root, header = self.elements[0], self.header
        assert isinstance(root, Amalthea)
        assert header is not None
        document = Document(root, header.version, self.path)
        document.source = source = self.source(header)
        document.prolog, document.epilog = self.prolog, self.epilog
        document.namespaces = header.namespaces
        findings = [collected.finding(self.path, source) for collected in self.collector]
        return ReadResult(
            document, self.references, self.hrefs, self.referables, self.xmi_ids, self.href_content, self.href_types, findings
        )

    def source(self, header: ModelHeader) -> SourceText:
        """The text, with what was read of it so far."""
        return SourceText(
            self.content,
            version=header.version,
            prefixes=Prefixes(header.xmi_id, header.xsi_type, header.type_prefix),
            elements=self.elements,
            other_tags=self.other_tags,
        )

    @cached_property
    def encoded(self) -> bytes:
        """The text as expat counts it."""
        return self.content.utf8

    # Elements

    def start_root(self, name: str, attributes: dict[str, str]) -> None:
        header = read_header(name, attributes)
        if isinstance(header, NotAModel):
            raise self.refuse(*header)
        self.header = header
        if problems.lacks_namespace(self.encoded):
            raise problems.undeclared_prefix(self.path, self.content, self.offset, "xsi", XSI_NAMESPACE)
        if header.version_note:
            added = "Additions of that version are preserved when the file is saved, but ignored otherwise."
            self.report("XMI007", Severity.WARNING, header.version_note, added)
        self.parser.StartElementHandler = self.start_part = self.start_handler(header)
        plan = plans(header.facts_version).of("Amalthea")
        assert plan is not None
        root = _new(plan.cls)
        set_container(root, None)
        self.stack.append((root, root.__dict__, plan.children))
        self.elements.append(root)
        for key in attributes.keys() - header.own_attributes:
            self.unknown_attribute(root, plan, key, attributes[key])

    def start_handler(self, header: ModelHeader) -> StartHandler:
        """The handler of start tags, with everything it needs in local names: it runs once per element."""
        stack, part = self.stack, plans(header.facts_version).part
        xmi_id, xsi_type = header.xmi_id, header.xsi_type
        foreign_prefix = None if header.type_prefix == TYPE_PREFIX else header.type_prefix
        add_element, referables, references, xmi_ids = self.elements.append, self.referables, self.references, self.xmi_ids
        pending_extras, max_depth = self.pending_extras, problems.MAX_DEPTH

        def start(name: str, attributes: dict[str, str]) -> None:
            parent, held, children = stack[-1]
            feature = children.get(name)
            if feature is None:
                self.start_unknown(name)
                return
            type_name = attributes.pop(xsi_type, None)
            if feature.is_reference:
                self.start_href(stack[-1], feature, attributes, type_name)
                return
            if foreign_prefix and type_name is not None:
                type_name = TYPE_PREFIX + type_name.removeprefix(foreign_prefix)
            plan = feature.parts.get(type_name) or part(feature, type_name)
            if plan is None:
                self.start_misplaced(feature, type_name)
                return
            feature_name = feature.name
            element = _new(plan.cls)
            if feature.many:
                parts = held.get(feature_name)
                if parts is None:
                    parts = held[feature_name] = _new_list(ContainmentList)
                    parts._owner = parent
                elif feature.only_one:
                    self.start_duplicate(feature)
                    return
                _append(parts, element)
            elif feature_name in held:
                self.start_duplicate(feature)
                return
            else:
                held[feature_name] = element
            set_container(element, parent)
            values = element.__dict__
            stack.append((element, values, plan.children))
            add_element(element)
            if plan.wave is not None:
                referables[plan].append(element)
            known = plan.attributes
            for key, value in attributes.items():
                attribute = known.get(key)
                if attribute is None:
                    if key == xmi_id:
                        xmi_ids[element] = value
                    else:
                        self.unknown_attribute(element, plan, key, value)
                elif attribute.is_reference:
                    if value and not value.isspace():
                        references[attribute].append(element)
                        values[attribute.name] = value
                elif attribute.parsed is None:
                    values[attribute.name] = value
                else:
                    try:
                        values[attribute.name] = attribute.parsed[value]
                    except ValueError as error:
                        self.invalid_value(element, key, value, error)
            if pending_extras:
                self.attach_extras(parent, element)
            if len(stack) > max_depth:
                raise self.too_deep()

        return start

    def end_handler(self) -> EndHandler:
        """The handler of end tags as long as no content has to be kept."""
        close = self.stack.pop

        def end(_name: str) -> None:
            close()

        return end

    def end_with_extras(self, _name: str) -> None:
        """The handler of end tags in a file with content that has to be kept."""
        element, _, _ = self.stack.pop()
        if element is not None and self.pending_extras:
            self.attach_extras(element, None)

    def start_href(self, frame: Frame, feature: FeaturePlan, attributes: dict[str, str], type_name: str | None) -> None:
        """A reference to another file: `<task href="amlt:/#T?type=Task"/>`."""
        href = attributes.get("href")
        if href is None or len(attributes) > 1:
            self.start_unknown(feature.xml_name)
            return
        text = href.partition("#")[2] or href
        if type_name is not None:
            self.href_types[text] = type_name.rpartition(":")[2]
        holder, held, _ = frame
        texts = held.get(feature.name)
        if texts is None:
            texts = held[feature.name] = []
            self.hrefs[feature].append(holder)
        elif isinstance(texts, str) or not feature.many:
            self.start_duplicate(feature)
            return
        self.href = (holder, feature.name, len(texts))
        texts.append(text)
        self.other_tags.append(len(self.elements))
        self.stack.append((None, {}, {}))

    # What the metamodel does not know

    def start_unknown(self, name: str) -> None:
        holder, _, children = self.stack[-1]
        where = type(holder).__name__ if holder is not None else "a reference"
        message = f"unknown element <{name}> in {where} (AMALTHEA {self.version})"
        self.collector.add(
            CollectedFinding("XMI010", Severity.WARNING, message, _KEPT, self.offset),
            name,
            children,
        )
        self.skip()

    def start_misplaced(self, feature: FeaturePlan, type_name: str | None) -> None:
        where, target = type(self.stack[-1][0]).__name__, feature.target.__name__
        if type_name is None:
            message = f"<{feature.xml_name}> in {where} has no xsi:type, and its declared class {target} is abstract"
            hint = "Add an xsi:type. "
        else:
            given = type_name.removeprefix(TYPE_PREFIX)
            message = (
                f"<{feature.xml_name}> in {where} has type {given}, expected {target} or a subclass of AMALTHEA {self.version}"
            )
            hint = "Correct the xsi:type. "
        self.report("XMI012", Severity.ERROR, message, hint + _KEPT)
        self.skip()

    def start_duplicate(self, feature: FeaturePlan) -> None:
        where = type(self.stack[-1][0]).__name__
        message = f"{where} can have only one <{feature.xml_name}>, this is another one"
        if feature.is_reference and feature.many:
            message = f"{feature.xml_name!r} of {where} is given as an attribute and as an element"
        self.report(
            "XMI014",
            Severity.ERROR,
            message,
            "The first one is used; this one is preserved when the file is saved, but ignored otherwise.",
        )
        self.skip()

    def skip(self) -> None:
        """Skip the element of the current start tag and everything in it."""
        self.skipped_depth = 1
        self.skipped_start = self.offset
        self.other_tags.append(len(self.elements))
        self.parser.StartElementHandler = self.start_skipped
        self.parser.EndElementHandler = self.end_skipped

    def start_skipped(self, _name: str, _attributes: dict[str, str]) -> None:
        self.skipped_depth += 1
        self.other_tags.append(len(self.elements))

    def end_skipped(self, _name: str) -> None:
        self.skipped_depth -= 1
        if self.skipped_depth:
            return
        self.parser.StartElementHandler = self.start_part
        self.parser.EndElementHandler = self.end_part
        start, end = self.skipped_start, self.offset
        # The position of expat is at the end tag of an element with content, but after the tag of an empty one.
        encoded = self.encoded
        is_empty = encoded[end - 2 : end] == b"/>" and encoded.find(b"<", start + 1, end) < 0
        if not is_empty:
            end = encoded.index(b">", end) + 1
        self.keep_extra(encoded[start:end].decode())

    def characters(self, data: str) -> None:
        text = data.strip(WHITE_SPACE)
        if not text or self.skipped_depth:
            return
        message = f"text {text[:30]!r} between the elements"
        self.report("XMI015", Severity.WARNING, message, "Remove it; a model has no text between its elements.")
        self.keep_extra(escape_text(text))

    def comment(self, data: str) -> None:
        self.keep_extra(f"<!--{data}-->")

    def processing_instruction(self, target: str, data: str) -> None:
        self.keep_extra(f"<?{target} {data}?>" if data else f"<?{target}?>")

    def keep_extra(self, raw: str) -> None:
        """Keep what the metamodel cannot represent at the open element."""
        if self.skipped_depth:
            return
        holder = self.stack[-1][0] if self.stack else None
        if holder is not None:
            self.pending_extras.setdefault(holder, []).append(raw)
            self.parser.EndElementHandler = self.end_part = self.end_with_extras
        elif self.stack and self.href is not None:
            self.href_content.setdefault(self.href, []).append(raw)
        else:
            (self.epilog if self.elements else self.prolog).append(raw)

    def attach_extras(self, holder: Element, anchor: Element | None) -> None:
        """Attach what was kept inside `holder` to the part that follows it."""
        for raw in self.pending_extras.pop(holder, ()):
            extras_of(holder).content.append((anchor, raw))

    def unknown_attribute(self, element: Element, plan: ClassPlan, key: str, value: str) -> None:
        extras_of(element).attributes[key] = value
        if key.startswith("xmlns"):
            return
        message = f"unknown attribute {key!r} of {type(element).__name__} (AMALTHEA {self.version})"
        self.collector.add(CollectedFinding("XMI011", Severity.WARNING, message, _KEPT, self.offset, key), key, plan.attributes)

    def invalid_value(self, element: Element, key: str, value: str, error: ValueError) -> None:
        extras_of(element).attributes[key] = value
        message = f"attribute {key!r} of {type(element).__name__}: {error}"
        self.report(
            "XMI013",
            Severity.ERROR,
            message,
            "Correct the value. It is preserved when the file is saved, but the attribute counts as unset.",
            key,
        )

    # Findings

    @property
    def offset(self) -> int:
        offset: int = self.parser.CurrentByteIndex
        return offset

    @property
    def version(self) -> str:
        return self.header.facts_version if self.header else ""

    def report(self, rule: str, severity: Severity, message: str, help_text: str, attribute: str = "") -> None:
        self.collector.add(CollectedFinding(rule, severity, message, help_text, self.offset, attribute))

    def refuse(self, rule: str, message: str, help_text: str) -> ReadError:
        return problems.refusal(self.path, self.content, self.offset, rule, message, help_text)

    def refuse_doctype(self, *_declaration: Any) -> None:
        raise problems.has_doctype(self.path, self.content, self.offset)

    def too_deep(self) -> ReadError:
        return problems.too_deep(self.path, self.content, self.offset)

    def malformed(self, error: expat.ExpatError) -> ReadError:
        held = next((frame[0] for frame in reversed(self.stack) if frame[0] is not None), None)
        opened = None
        if held is not None and self.header is not None:
            opened = (type(held).__name__, self.source(self.header).position_of(held).line)
        return problems.malformed(self.path, self.content, error, self.parser.ErrorByteIndex, opened)
