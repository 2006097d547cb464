"""Document -> text.

What was read and not changed is copied from the source. A changed object is compared with its place in the source, and whatever of
it still says the same stays to the letter; the rest is written as EMF does. So a file that EMF wrote, and also one that a person laid
out and commented, differs after saving only where the model differs.
"""

from __future__ import annotations

import re

from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.changes import spread_renames
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.source import Prefixes, Source
from amalthea_uros.metamodel.versions import NAMESPACE_PREFIX, version_key
from amalthea_uros.xmi.escape import escape
from amalthea_uros.xmi.header import XMI_NAMESPACE, XSI_NAMESPACE
from amalthea_uros.xmi.plan import ClassPlan, FeaturePlan
from amalthea_uros.xmi.reader import MAX_DEPTH
from amalthea_uros.xmi.spell import Child, Part, Shape, Speller
from amalthea_uros.xmi.weave import Weaver

_DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>'
_INDENT = "  "


def document_text(document: Document, canonical: bool = False) -> str:
    """The text of a document.

    Parameters
    ----------
    canonical : write everything as EMF does, whatever the source looks like; comments and unknown content stay

    Raises
    ------
    WriteError : something in the document is not allowed in its AMALTHEA version; carries a finding for each.
    """
    source = None if canonical else _usable_source(document)
    if source is not None:
        spread_renames((d.root, d.changes) for d in document.model.documents)
        if not document.changes.touched:
            return source.text
    writer = _Writer(document, source)
    text = writer.document()
    if writer.speller.findings:
        # What differs from the source is spelled twice.
        raise WriteError(dict.fromkeys(writer.speller.findings))
    return text


def _usable_source(document: Document) -> Source | None:
    """The source, unless the document got another root or is to become one of another version."""
    source = document.source
    if source is None or source.elements[0] is not document.root or source.version != document.version:
        return None
    return source


class _Writer:
    def __init__(self, document: Document, source: Source | None) -> None:
        self.root = document.root
        self.touched = document.changes.touched
        self.source = source
        self.index = source.index if source else {}
        self.newline = source.newline if source else "\n"
        self.speller = Speller(document, source.prefixes if source else Prefixes())
        self.weaver = Weaver(document, source, self.speller) if source else None
        self.version = document.version
        self.outside = (document.prolog, document.epilog)
        self.depth = 1
        self.out: list[str] = []

    def document(self) -> str:
        """The whole text."""
        plan = self.speller.plan(self.root)
        if plan is None:
            return ""
        shape = self.speller.shape(plan, self.root)
        children = self.speller.children(self.root, shape)
        tag = f"{self.speller.prefixes.type_prefix}Amalthea"
        if self.source and self.weaver:
            place = self.index[self.root]
            self.out.append(self.source.text[: self.source.start(place)])
            opening, at = self.weaver.tag(self.root, plan, {}, place)
            self.out.append(opening)
            self.woven_content(self.root, tag, children, "", place, at)
            opening_at = 1
            self.out.append(self.source.text[self.weaver.end(place) :])
        else:
            prolog, epilog = self.outside
            self.out += [_DECLARATION, self.newline, *(raw + self.newline for raw in prolog)]
            opening_at = len(self.out)
            self.out.append("")
            self.fresh_content(self.root, tag, children, "")
            self.out += [self.newline, *(raw + self.newline for raw in epilog)]
            self.out[opening_at] = f"<{tag}{self.root_attributes()}{_extra_attributes(self.root)}"
        prefix = self.speller.prefixes.xsi_type.partition(":")[0]
        if self.speller.uses_xsi and not re.search(rf"\sxmlns:{prefix}\s*=", self.out[opening_at]):
            self.out[opening_at] += f' xmlns:{prefix}="{XSI_NAMESPACE}"'
        return "".join(self.out)

    def root_attributes(self) -> str:
        """What XML and XMI demand of the root element, in EMF's order."""
        xsi = f' xmlns:xsi="{XSI_NAMESPACE}"' if self.speller.uses_xsi else ""
        own = f' xmlns:am="{NAMESPACE_PREFIX}{self.version}"'
        # The order changed with 1.0.0, when APP4MC no longer used Sphinx.
        spaces = xsi + own if version_key(self.version) >= (1,) else own + xsi
        return f' xmi:version="2.0" xmlns:xmi="{XMI_NAMESPACE}"{spaces}'

    def part(self, part: Part, indent: str) -> None:
        """Write an object and everything in it."""
        feature, element = part
        tag = feature.xml_name
        place = self.index.get(element)
        if self.weaver is None or self.source is None or (place is not None and not self.weaver.stands_as(tag, place)):
            place = None
        elif place is not None and element not in self.touched:
            self.out.append(self.source.text[self.source.start(place) : self.weaver.end(place)])
            return
        if self.depth == MAX_DEPTH:
            # The reader refuses what is nested deeper, and `part` itself runs into the recursion limit of Python.
            self.speller.refuse(element, f"is nested more than {MAX_DEPTH} deep")
            return
        self.depth += 1
        self.whole_part(feature, element, place, indent)
        self.depth -= 1

    def whole_part(self, feature: FeaturePlan, element: Element, place: int | None, indent: str) -> None:
        """Write an object that changed, or that the source does not hold."""
        plan = self.speller.plan(element)
        if plan is None:
            return
        tag = feature.xml_name
        shape = self.speller.shape(plan, element)
        children = self.speller.children(element, shape) if shape.children else []
        attributes = self.speller.tag(feature, plan, element, shape)
        if self.weaver is None or self.source is None or place is None:
            self.out.append(f"<{tag}{self.with_extras(feature, element, plan, shape) if shape.has_extras else attributes}")
            self.fresh_content(element, tag, children, indent)
            return
        opening = f"<{tag}{attributes}"
        start = self.source.start(place)
        at = start + len(opening)
        if not self.source.text.startswith(opening, start) or self.source.text[at] not in "/>":
            wanted = self.speller.attributes(feature, plan, element, shape)
            opening, at = self.weaver.tag(element, plan, wanted, place)
        self.out.append(opening)
        self.woven_content(element, tag, children, indent, place, at)

    def with_extras(self, feature: FeaturePlan, element: Element, plan: ClassPlan, shape: Shape) -> str:
        """The attributes of an object with those of its file that are not understood, as far as nothing was set in their place."""
        wanted = self.speller.attributes(feature, plan, element, shape)
        for key, text in element.extras.attributes.items() if element.extras else ():
            known = plan.attributes.get(key)
            if known is None or element.__dict__.get(known.name) in (None, []):
                wanted[key] = text
        return "".join(f' {key}="{escape(text)}"' for key, text in wanted.items())

    def fresh_content(self, element: Element, tag: str, children: list[Child], indent: str) -> None:
        """The end of the start tag, the children, and the end tag, laid out as EMF does."""
        out, inner = self.out, indent + _INDENT
        separator = self.newline + inner
        extra = element.extras.content if element.extras else []
        if not children and not extra:
            out.append("/>")
            return
        out.append(">")
        loose: dict[Element | None, list[str]] = {}
        present = {child.element for child in children if isinstance(child, Part)} if extra else set()
        for anchor, raw in extra:
            loose.setdefault(anchor if anchor in present else None, []).append(raw)
        for child in children:
            if isinstance(child, Part):
                out += [separator + raw for raw in loose.get(child.element, ())]
                out.append(separator)
                self.part(child, inner)
            else:
                out.append(separator + child.tag)
        out += [separator + raw for raw in loose.get(None, ())]
        out.append(f"{self.newline}{indent}</{tag}>")

    def woven_content(self, element: Element, tag: str, children: list[Child], indent: str, place: int, at: int) -> None:
        """The same for an object of the source, whose start tag ends at an offset."""
        assert self.source
        assert self.weaver
        text, out = self.source.text, self.out
        separator = self.newline + indent + _INDENT
        if text[at] == "/":
            extra = element.extras is not None and element.extras.content
            if children or extra:
                out[-1] = out[-1].rstrip()
                self.fresh_content(element, tag, children, indent)
            else:
                out.append("/>")
            return
        content, end = at + 1, self.source.end(place)
        if self.weaver.is_regular(children, content, end, separator):
            out.append(">")
            for child in children:
                out.append(separator)
                if isinstance(child, Part):
                    self.part(child, indent + _INDENT)
                else:
                    out.append(child.tag)
            out.append(text[end - len(separator) + len(_INDENT) : self.weaver.end(place)])
            return
        items = self.weaver.content(element, children, content, end, separator)
        if not items and content != end:
            out.append("/>")
            return
        out.append(">")
        inner = indent + _INDENT
        for item in items:
            if isinstance(item, Part):
                self.part(item, inner)
            else:
                out.append(item)
                if item.isspace():
                    inner = item.rpartition("\n")[2]
        out.append(text[end : self.weaver.end(place)])


def _extra_attributes(element: Element) -> str:
    extras = element.extras
    return "".join(f' {key}="{escape(value)}"' for key, value in extras.attributes.items()) if extras else ""
