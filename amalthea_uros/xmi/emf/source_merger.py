"""Merging modified objects into the text from which they were read, where that text does not have EMF's layout.

`tag` gives a start tag of which some attributes changed, `content` the content of an element of which children were added, removed
or moved. Everything that still has the same meaning is preserved byte for byte: order, white space, quotes, comments, unknown
attributes and elements.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable, Iterator
from functools import cached_property
from itertools import zip_longest
from math import copysign
from typing import Any, NamedTuple

from amalthea_uros.metamodel.element import Element, extras_if_any
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.source import SourceText
from amalthea_uros.metamodel.tags import ElementEnd, attributes_of_tag
from amalthea_uros.xmi.emf.escape import escape, unescape
from amalthea_uros.xmi.emf.plan import ClassPlan, reference_texts
from amalthea_uros.xmi.emf.serializer import Child, ChildPart, ChildReference, EmfSerializer, tag_of

_NAME = re.compile(r"[^\s/>]+")


class SourcePiece(NamedTuple):
    """A piece of the content of an element in the source.

    Attributes
    ----------
    child : the present part or reference that it represents, None for everything else
    kept : whether it is written again, that is, not removed from the model
    """

    text: str
    child: Child | None
    kept: bool


class SourceMerger:
    """Reads the source of one document again, to preserve the way in which it is written."""

    def __init__(self, document: Document, source: SourceText, serializer: EmfSerializer) -> None:
        self.document = document
        self.source = source
        self.text = source.text
        self.serializer = serializer
        self.ends: dict[int, ElementEnd] = {}

    def end(self, place: int) -> ElementEnd:
        """Where an object ends."""
        end = self.ends.get(place)
        if end is None:
            end = self.ends[place] = self.source.content.end(self.source.starts[place])
        return end

    def is_same_part(self, tag: str, place: int) -> bool:
        """Whether the object was held by the same feature when it was read."""
        start = self.source.starts[place]
        return self.text.startswith(tag, start + 1) and self.text[start + 1 + len(tag)] in " \t\r\n/>"

    def ends_in_emf_layout(self, holder: Element, children: list[Child], at: int, end: int, separator: str) -> list[int] | None:
        """The offset after each child if the content between two offsets consists of exactly these, in order and in EMF's layout."""
        extras = extras_if_any(holder)
        if extras and extras.content:
            return None
        text, source, index = self.text, self.source, self.source.index
        ends = []
        for child, following in zip_longest(children, children[1:]):
            if not text.startswith(separator, at):
                return None
            at += len(separator)
            if isinstance(child, ChildReference):
                if not text.startswith(child.tag, at):
                    return None
                at += len(child.tag)
            else:
                place = index.get(child.element)
                if place is None or source.starts[place] != at or not self.is_same_part(child.feature.xml_name, place):
                    return None
                at = self.end_before(child, following, separator) or self.end(place).element
            ends.append(at)
        return ends if at <= end and text[at:end] == separator[: -len("  ")] else None

    def end_before(self, child: ChildPart, following: Child | None, separator: str) -> int | None:
        """The offset after a child in EMF's layout that is followed by another one, without a look at its tags; None if it needs one.

        In a text without comments, unknown elements and references to other files, all that precedes the next child is the last object
        in this one, unless another object was between them. Nothing was moved into this one if it is not modified.
        """
        place = self.source.index.get(following.element) if isinstance(following, ChildPart) else None
        if not place or not self.has_objects_only or child.element in self.document.changes.modified:
            return None
        last: Element | None = self.source.elements[place - 1]
        while last is not None and last is not child.element:
            last = last.container
        end = self.source.starts[place] - len(separator)
        return end if last is not None and self.text[end - 1] == ">" else None

    def is_untouched(self, place: int, end: int) -> bool:
        """Whether nothing was modified of an object in the source, and in it, up to its end."""
        number = bisect_left(self.modified_places, place)
        following = self.modified_places[number : number + 1]
        return not following or self.source.starts[following[0]] >= end

    @cached_property
    def modified_places(self) -> list[int]:
        """Where the source has objects that were modified, also those that were removed."""
        index = self.source.index
        return sorted(index[element] for element in self.document.changes.modified if element in index)

    @cached_property
    def has_objects_only(self) -> bool:
        """Whether each tag of the text is one of an object, and its tags are those that were read."""
        source = self.source
        return not source.other_tags and source.byte_starts is None and source.content.has_tags_only

    # Start tags

    def tag(self, element: Element, plan: ClassPlan, wanted: dict[str, str], place: int) -> tuple[str, int]:
        """A start tag with the wanted attributes, without its `>` or `/>`, and the offset of these."""
        start = self.source.starts[place]
        name = _NAME.match(self.text, start + 1)
        assert name
        at = name.end()
        pieces: dict[str, str] = {}
        for attribute in attributes_of_tag(self.text, start):
            at = attribute.end()
            key, value = attribute["name"], unescape(attribute["quoted"][1:-1])
            if self.is_unchanged(element, plan, key, value, wanted.get(key)):
                pieces[key] = attribute[0]
            elif key in wanted:
                lead = attribute[0][: attribute.start("quoted") - attribute.start()]
                pieces[key] = f'{lead}"{escape(wanted[key])}"'
        tag = name[0] + "".join(self.with_new(element, plan, pieces, wanted))
        tail = re.compile(r"\s*").match(self.text, at)
        assert tail
        return f"<{tag}{tail[0]}", tail.end()

    def with_new(self, element: Element, plan: ClassPlan, pieces: dict[str, str], wanted: dict[str, str]) -> list[str]:
        """The attributes that stay, and those that were set since, each after its predecessor in EMF's order."""
        order = list(pieces)
        before = None
        for key, value in wanted.items():
            if key not in pieces:
                if not self.was_set(element, plan, key):
                    continue
                pieces[key] = f' {key}="{escape(value)}"'
                order.insert(order.index(before) + 1 if before else 0, key)
            before = key
        return [pieces[key] for key in order]

    def was_set(self, element: Element, plan: ClassPlan, key: str) -> bool:
        """Whether an attribute that the source does not have was set since; defaults and ids may be absent in a file."""
        feature = plan.attributes.get(key)
        if feature is not None:
            return element.__dict__.get(feature.name) is not None
        return key == self.serializer.prefixes.xsi_type

    def is_unchanged(self, element: Element, plan: ClassPlan, key: str, value: str, wanted: str | None) -> bool:
        """Whether an attribute of the source still has the value of the object."""
        if value == wanted:
            return True
        if key == self.serializer.prefixes.xsi_type:
            return value.removeprefix(self.serializer.prefixes.type_prefix) == plan.cls.__name__
        spelling = self.document.spellings.get((element, "xmi:id" if key == self.serializer.prefixes.xmi_id else key))
        if spelling is not None:
            return spelling == (value, wanted or "")
        feature = plan.attributes.get(key)
        extras = element.extras
        if feature is None or (extras and extras.attributes.get(key) == value):
            is_own = element is self.document.root and (extras is None or key not in extras.attributes)
            return is_own or bool(extras and extras.attributes.get(key) == value)
        if feature.is_reference:
            written = self.canonical_references(element, key, reference_texts(feature, value))
            return written == reference_texts(feature, wanted or "")
        assert feature.data_type
        current = element.__dict__.get(feature.name)
        if current is None:
            return wanted is not None and _equal(_parsed(feature.data_type.parse, value), feature.data_type.parse(wanted))
        return _equal(_parsed(feature.data_type.parse, value), current)

    def canonical_references(self, element: Element, key: str, references: list[str]) -> list[str]:
        """References in the form in which we write them, where the source has another one."""
        spellings = self.document.spellings
        found = (spellings.get((element, f"{key} {reference}")) for reference in references)
        return [spelling.canonical if spelling else reference for spelling, reference in zip(found, references, strict=True)]

    # Content

    def content(self, element: Element, children: list[Child], at: int, end: int, separator: str) -> list[str | ChildPart]:
        """The content between two offsets of the source, with the present children: text to copy and parts to write.

        Parameters
        ----------
        separator : white space before a child, unless the source gives an example
        """
        extra = [raw for _, raw in element.extras.content if tag_of(raw)] if element.extras else []
        nodes = list(self.nodes(element, children, extra, at, end))
        separator = next((n.text for n in nodes if n.text.isspace() and "\n" in n.text), separator if not nodes else "")
        new_extra = [piece for raw in extra for piece in (separator, raw)]
        if not _in_order(nodes, children) or _would_follow_duplicate(nodes, children):
            return _reordered(nodes, children, new_extra, separator)
        after, before = _added(nodes, children)
        found: list[str | ChildPart] = [item for child in after.get(None, ()) for item in (separator, _item(child))]
        for node in nodes:
            if node.kept:
                found += [item for child in before.get(id(node.child), ()) for item in (_item(child), separator)]
                found.append(node.child if isinstance(node.child, ChildPart) else node.text)
                found += [item for child in after.get(id(node.child), ()) for item in (separator, _item(child))]
            elif found and isinstance(found[-1], str) and found[-1].isspace():
                found.pop()
        if len(new_extra) > 0:
            found[_before_last_space(found) : _before_last_space(found)] = new_extra
        is_blank = all(isinstance(item, str) and item.isspace() for item in found)
        return [] if is_blank and not all(node.kept for node in nodes) else found

    def nodes(self, element: Element, children: list[Child], extra: list[str], at: int, end: int) -> Iterator[SourcePiece]:
        """The pieces of the content of an element; unknown elements that are found are removed from `extra`."""
        parts = {child.element: child for child in children if isinstance(child, ChildPart)}
        hrefs = [child for child in children if isinstance(child, ChildReference)]
        while at < end:
            start = at
            place = self.source.by_start.get(start)
            if place is not None:
                at = self.end(place).element
                part = parts.get(self.source.elements[place])
                stays = part is not None and self.is_same_part(part.feature.xml_name, place)
                yield SourcePiece(self.text[start:at], part if stays else None, stays)
                continue
            match = self.source.content.node(start)
            if not match["open"]:
                at = match.end()
                yield SourcePiece(match[0], None, True)
                continue
            at = self.source.content.end(start).element
            raw = self.text[start:at]
            href = self._take_href(element, match, hrefs)
            if href is None and raw in extra:
                extra.remove(raw)
                yield SourcePiece(raw, None, True)
            else:
                yield SourcePiece(raw, href, href is not None)

    def _take_href(self, element: Element, opening: re.Match[str], hrefs: list[ChildReference]) -> ChildReference | None:
        """The present reference that an element of the source represents; each is used once."""
        for attribute in attributes_of_tag(self.text, opening.start()):
            if attribute["name"] != "href":
                continue
            value = unescape(attribute["quoted"][1:-1])
            (reference,) = self.canonical_references(element, opening["open"], [value.partition("#")[2] or value])
            for i, href in enumerate(hrefs):
                if href.feature.xml_name == opening["open"] and href.reference == reference:
                    return hrefs.pop(i)
        return None


def _parsed(parse: Callable[[str], Any], text: str) -> Any:
    try:
        return parse(text)
    except ValueError:
        return None


def _equal(one: Any, other: Any) -> bool:
    """Whether two values are written alike; a negative zero equals zero."""
    return bool(one == other) and (not isinstance(one, float) or copysign(1, one) == copysign(1, other))


def _item(child: Child) -> str | ChildPart:
    return child if isinstance(child, ChildPart) else child.tag


def _before_last_space(found: list[str | ChildPart]) -> int:
    last = found[-1] if found else None
    return len(found) - 1 if isinstance(last, str) and last.isspace() else len(found)


def _in_order(nodes: list[SourcePiece], children: list[Child]) -> bool:
    """Whether the children that stay have the order of the source within each feature; between features the order has no meaning."""
    positions = {id(child): position for position, child in enumerate(children)}
    last: dict[str, int] = {}
    for node in nodes:
        if node.child is not None:
            position = positions[id(node.child)]
            if position < last.get(node.child.feature.xml_name, -1):
                return False
            last[node.child.feature.xml_name] = position
    return True


def _would_follow_duplicate(nodes: list[SourcePiece], children: list[Child]) -> bool:
    """Whether a new value could get behind an unknown one of the same feature, so that this one would count instead."""
    present = {id(node.child) for node in nodes}
    unknown = {tag_of(node.text) for node in nodes if node.kept and node.child is None}
    return any(child.feature.xml_name in unknown and id(child) not in present for child in children)


def _added(nodes: list[SourcePiece], children: list[Child]) -> tuple[dict[int | None, list[Child]], dict[int, list[Child]]]:
    """The children that the source does not have, by the id of the child after which (None: first) or before which they belong."""
    present = {id(node.child) for node in nodes}
    firsts: dict[str, Child] = {}
    for child in children:
        if id(child) in present:
            firsts.setdefault(child.feature.xml_name, child)
    after: dict[int | None, list[Child]] = {}
    before: dict[int, list[Child]] = {}
    last: Child | None = None
    for child in children:
        first = firsts.get(child.feature.xml_name)
        if id(child) in present:
            last = child
        elif first is not None and (last is None or last.feature is not child.feature):
            # In the source the children of preceding features may come after those of this one.
            before.setdefault(id(first), []).append(child)
        else:
            after.setdefault(id(last) if last else None, []).append(child)
    return after, before


def _reordered(nodes: list[SourcePiece], children: list[Child], extra: list[str], separator: str) -> list[str | ChildPart]:
    """The children in EMF's order, because their new order contradicts that of the source; comments first, unknown elements last."""
    others = [node.text for node in nodes if node.kept and node.child is None and not node.text.isspace()]
    found: list[str | ChildPart] = [piece for text in others if not tag_of(text) for piece in (separator, text)]
    extra = [*(piece for text in others if tag_of(text) for piece in (separator, text)), *extra]
    by_child = {id(node.child): node for node in nodes if isinstance(node.child, ChildReference)}
    for child in children:
        found += [separator, by_child[id(child)].text if id(child) in by_child else _item(child)]
    return [*found, *extra, nodes[-1].text if nodes[-1].text.isspace() else ""]
