"""Document -> text.

What was read and not modified is copied from the source. A modified object is compared with its text in the source: what still has
the same meaning is preserved byte for byte, and the rest is written as EMF does. So a file that EMF wrote, and also one that a person
formatted and commented, differs after saving only where the model differs.
"""

from __future__ import annotations

import re
from itertools import groupby

from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, propagate_renames
from amalthea_uros.metamodel.source import Prefixes, SourceText
from amalthea_uros.metamodel.versions import NAMESPACE_PREFIX, version_key
from amalthea_uros.xmi.emf.escape import escape
from amalthea_uros.xmi.emf.header import XMI_NAMESPACE, XSI_NAMESPACE
from amalthea_uros.xmi.emf.plan import ClassPlan, FeaturePlan
from amalthea_uros.xmi.emf.problems import MAX_DEPTH
from amalthea_uros.xmi.emf.read_back import check_read_back
from amalthea_uros.xmi.emf.serializer import Child, ChildPart, EmfSerializer, KeptContent, used_prefixes
from amalthea_uros.xmi.emf.source_merger import SourceMerger

_DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>'
_INDENT = "  "
_OWN_PREFIX = Prefixes().type_prefix.rstrip(":")


def document_text(document: Document, canonical: bool = False) -> str:
    """The text of a document.

    Parameters
    ----------
    canonical : write everything in EMF's layout, whatever the source looks like; comments and unknown content are preserved

    Raises
    ------
    WriteError : the AMALTHEA version of the document does not allow something in it; carries a finding for each such thing. Or
        the text would be read as another model.
    """
    source = None if canonical else usable_source(document)
    if source is not None:
        propagate_renames((d.root, d.changes) for d in document.model.documents)
        if not document.changes.modified:
            return source.text
    writer = _Writer(document, source)
    text = writer.document()
    if writer.serializer.findings:
        # What differs from the source is serialised twice.
        raise WriteError(dict.fromkeys(writer.serializer.findings))
    is_as_read = document.source is not None and document.source.text == text and not document.changes.modified
    if not is_as_read:
        check_read_back(writer.out, writer.copied, document, writer.serializer, writer.merger)
    return text


def usable_source(document: Document) -> SourceText | None:
    """The source, unless the root or the version of the document was replaced, so that everything has to be written anew."""
    source = document.source
    if source is None or source.elements[0] is not document.root or source.version != document.version:
        return None
    return source


class _Writer:
    def __init__(self, document: Document, source: SourceText | None) -> None:
        self.root = document.root
        self.source = source
        self.index = source.index if source else {}
        self.newline = source.newline if source else "\n"
        self.serializer = EmfSerializer(document, source.prefixes if source else canonical_prefixes(document))
        self.merger = SourceMerger(document, source, self.serializer) if source else None
        self.version = document.version
        self.namespaces = known_namespaces(document)
        self.outside = (document.prolog, document.epilog)
        self.depth = 1
        self.out: list[str] = []
        #: The objects whose text is copied with everything in it, successive ones of a feature, by the number of the piece in `out`.
        self.copied: dict[int, list[Element]] = {}

    def document(self) -> str:
        """The whole text."""
        plan = self.serializer.plan(self.root)
        if plan is None:
            return ""
        write_plan = self.serializer.write_plan(plan, self.root)
        children = self.serializer.children(self.root, write_plan)
        tag = f"{self.serializer.prefixes.type_prefix}Amalthea"
        if self.source and self.merger:
            place = self.index[self.root]
            self.out.append(self.source.text[: self.source.starts[place]])
            opening, at = self.merger.tag(self.root, plan, {}, place)
            self.out.append(opening)
            self.merged_content(self.root, tag, children, "", place, at)
            opening_at = 1
            self.out.append(self.source.text[self.merger.end(place).element :])
        else:
            prolog, epilog = self.outside
            self.out += [_DECLARATION, self.newline, *(raw + self.newline for raw in prolog)]
            opening_at = len(self.out)
            self.out.append("")
            self.canonical_content(self.root, tag, children, "")
            self.out += [self.newline, *(raw + self.newline for raw in epilog)]
            self.out[opening_at] = f"<{tag}{self.root_attributes()}"
        self.out[opening_at] += self.missing_declarations(self.out[opening_at])
        if not self.source:
            self.out[opening_at] += _attributes_text(self.root.extras.attributes if self.root.extras else {})
        return "".join(self.out)

    def missing_declarations(self, opening: str) -> str:
        """The declarations that the root element, whose start tag is given, needs for what was written."""
        needed = {prefix: self.namespaces[prefix] for prefix in self.kept_prefixes()}
        if self.serializer.uses_xsi:
            needed[self.serializer.prefixes.xsi_type.partition(":")[0]] = XSI_NAMESPACE
        missing = (prefix for prefix in needed if not re.search(rf"\sxmlns:{re.escape(prefix)}\s*=", opening))
        return "".join(f' xmlns:{prefix}="{escape(needed[prefix])}"' for prefix in missing)

    def kept_prefixes(self) -> list[str]:
        """The prefixes that unknown content needs, in the order of their declarations."""
        used = used_prefixes(self.serializer.kept)
        is_foreign = self.source is None and self.serializer.prefixes.type_prefix != Prefixes().type_prefix
        return [prefix for prefix in self.namespaces if prefix in used or (is_foreign and prefix == _OWN_PREFIX)]

    def root_attributes(self) -> str:
        """The attributes of the root element that XML and XMI require, in EMF's order."""
        uses_xsi = self.serializer.uses_xsi or "xsi" in self.kept_prefixes()
        xsi = f' xmlns:xsi="{XSI_NAMESPACE}"' if uses_xsi else ""
        own = f' xmlns:{self.serializer.prefixes.type_prefix[:-1]}="{NAMESPACE_PREFIX}{self.version}"'
        # The order changed with 1.0.0, when APP4MC no longer used Sphinx.
        spaces = xsi + own if version_key(self.version) >= (1,) else own + xsi
        return f' xmi:version="2.0" xmlns:xmi="{XMI_NAMESPACE}"{spaces}'

    def part(self, part: ChildPart, indent: str) -> None:
        """Write an object and everything in it."""
        feature, element = part
        tag = feature.xml_name
        place = self.index.get(element)
        if self.merger is None or self.source is None or (place is not None and not self.merger.is_same_part(tag, place)):
            place = None
        elif place is not None and self.merger.is_untouched(place, self.merger.end(place).element):
            self.copied[len(self.out)] = [element]
            self.out.append(self.source.text[self.source.starts[place] : self.merger.end(place).element])
            return
        if self.depth == MAX_DEPTH:
            # The reader refuses deeper nesting, and `part` would exceed the recursion limit of Python.
            self.serializer.refuse(element, f"nested more than {MAX_DEPTH} levels deep")
            return
        self.depth += 1
        self.whole_part(feature, element, place, indent)
        self.depth -= 1

    def whole_part(self, feature: FeaturePlan, element: Element, place: int | None, indent: str) -> None:
        """Write an object that was modified, or that is not in the source."""
        plan = self.serializer.plan(element)
        if plan is None:
            return
        tag = feature.xml_name
        write_plan = self.serializer.write_plan(plan, element)
        children = self.serializer.children(element, write_plan) if write_plan.children else []
        wanted = self.serializer.attributes(feature, plan, element, write_plan)
        if self.merger is None or self.source is None or place is None:
            if write_plan.has_extras:
                self.add_extras(wanted, element, plan)
            self.out.append(f"<{tag}{_attributes_text(wanted)}")
            self.canonical_content(element, tag, children, indent)
            return
        opening = f"<{tag}{_attributes_text(wanted)}"
        start = self.source.starts[place]
        at = start + len(opening)
        if not self.source.text.startswith(opening, start) or self.source.text[at] not in "/>":
            opening, at = self.merger.tag(element, plan, wanted, place)
        self.out.append(opening)
        self.merged_content(element, tag, children, indent, place, at)

    def add_extras(self, wanted: dict[str, str], element: Element, plan: ClassPlan) -> None:
        """Add the unknown attributes of an object in its file, unless they were replaced since."""
        for key, text in element.extras.attributes.items() if element.extras else ():
            known = plan.attributes.get(key)
            if known is None or element.__dict__.get(known.name) in (None, []):
                wanted[key] = text
                self.serializer.kept.append(f'{key}="{text}"')

    def canonical_content(self, element: Element, tag: str, children: list[Child], indent: str) -> None:
        """The end of the start tag, the children, and the end tag, in EMF's layout."""
        out, inner = self.out, indent + _INDENT
        separator = self.newline + inner
        extra = element.extras.content if element.extras else []
        if not children and not extra:
            out.append("/>")
            return
        out.append(">")
        kept = KeptContent.of(extra, children)
        self.serializer.kept += [raw for _, raw in extra]
        for child in children:
            if isinstance(child, ChildPart):
                out += [separator + raw for raw in kept.before.get(child.element, ())]
                out.append(separator)
                self.part(child, inner)
            else:
                out.append(separator + child.tag)
            out += [separator + raw for raw in kept.after.pop(child.feature.xml_name, ())]
        out += [separator + raw for raw in kept.before.get(None, ())]
        out.append(f"{self.newline}{indent}</{tag}>")

    def merged_content(self, element: Element, tag: str, children: list[Child], indent: str, place: int, at: int) -> None:
        """The same for an object that is in the source, where its start tag ends at an offset."""
        assert self.source
        assert self.merger
        text, out = self.source.text, self.out
        separator = self.newline + indent + _INDENT
        if text[at] == "/":
            extra = element.extras is not None and element.extras.content
            if children or extra:
                out[-1] = out[-1].rstrip()
                self.canonical_content(element, tag, children, indent)
            else:
                out.append("/>")
            return
        content, (end, after) = at + 1, self.merger.end(place)
        ends = self.merger.ends_in_emf_layout(element, children, content, end, separator)
        if ends is not None:
            out.append(">")
            self.emf_content(children, ends, content, indent + _INDENT)
            out.append(text[end - len(separator) + len(_INDENT) : after])
            return
        items = self.merger.content(element, children, content, end, separator)
        if not items and content != end:
            out.append("/>")
            return
        out.append(">")
        inner = indent + _INDENT
        for item in items:
            if isinstance(item, ChildPart):
                self.part(item, inner)
            else:
                out.append(item)
                if item.isspace():
                    inner = item.rpartition("\n")[2]
        out.append(text[end:after])

    def emf_content(self, children: list[Child], ends: list[int], at: int, indent: str) -> None:
        """Children that are in the source in EMF's layout, each up to an offset; successive ones that are copied are one piece."""
        assert self.source
        out, separator = self.out, self.newline + indent
        for (_, is_copied), group in groupby(zip(children, ends, strict=True), key=self.piece_of):
            pairs = list(group)
            last = pairs[-1][1]
            if is_copied:
                out.append(separator)
                self.copied[len(out)] = [child.element for child, _ in pairs if isinstance(child, ChildPart)]
                out.append(self.source.text[at + len(separator) : last])
            for child, _ in () if is_copied else pairs:
                out.append(separator)
                if isinstance(child, ChildPart):
                    self.part(child, indent)
                else:
                    out.append(child.tag)
            at = last

    def piece_of(self, pair: tuple[Child, int]) -> tuple[FeaturePlan, bool]:
        """The feature of a child, and whether nothing was modified in it."""
        assert self.merger
        child, end = pair
        return child.feature, isinstance(child, ChildPart) and self.merger.is_untouched(self.index[child.element], end)


def canonical_prefixes(document: Document) -> Prefixes:
    """The usual prefixes, unless the file needs `am` for something else."""
    foreign = document.namespaces.get(_OWN_PREFIX, NAMESPACE_PREFIX + document.version) != NAMESPACE_PREFIX + document.version
    own = document.source.prefixes.type_prefix if document.source else Prefixes().type_prefix
    return Prefixes(type_prefix=own) if foreign else Prefixes()


def known_namespaces(document: Document) -> dict[str, str]:
    """The namespaces of the file, and those of the other files of the model, from which unknown content may have moved."""
    found = dict(document.namespaces)
    for other in document.model.documents:
        for prefix, uri in other.namespaces.items():
            found.setdefault(prefix, uri)
    return found


def _attributes_text(attributes: dict[str, str]) -> str:
    return "".join([f' {key}="{escape(text)}"' for key, text in attributes.items()])
