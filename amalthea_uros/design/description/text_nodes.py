"""The nodes of a YAML text with the ranges of their characters, so that single values can be replaced.

The text has been read before (`spec.nodes`), so it is valid and within the limits. Nothing is resolved here: an alias is a node of its
own, and a merge key is a key.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Any, TypeAlias

import yaml

from amalthea_uros._internal.records import dataclass, field

MERGE = "<<"

#: The events and marks of libyaml and of PyYAML's own parser have no common type.
_Event: TypeAlias = Any
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(slots=True, kw_only=True)
class TextNode:
    """A range of characters.

    Attributes
    ----------
    start, end : indices of the first character, with an anchor before it, and of the one after the last
    anchor : the name of its anchor
    """

    start: int
    end: int
    anchor: str | None = None


@dataclass(slots=True, kw_only=True)
class TextScalar(TextNode):
    """A single value; `quote` is the character around it, "" for none, and "|" for a block."""

    value: str
    quote: str


@dataclass(slots=True, kw_only=True)
class TextAlias(TextNode):
    """A reference to a node with an anchor."""

    name: str


@dataclass(slots=True, kw_only=True)
class TextSequence(TextNode):
    """A list."""

    is_flow: bool
    items: list[AnyNode] = field(default_factory=list)


@dataclass(slots=True, kw_only=True)
class Entry:
    """A key, where it starts and ends, and its value."""

    key: str
    start: int
    end: int
    value: AnyNode


@dataclass(slots=True, kw_only=True)
class TextMapping(TextNode):
    """Values by key."""

    is_flow: bool
    entries: list[Entry] = field(default_factory=list)

    def entry(self, key: str) -> Entry | None:
        """The entry of a key, without those that are merged into the mapping."""
        return next((entry for entry in self.entries if entry.key == key), None)


AnyNode: TypeAlias = TextScalar | TextAlias | TextSequence | TextMapping


@dataclass(slots=True)
class YamlDocument:
    """A document: its root, and the nodes with anchors by the order of their occurrence.

    Attributes
    ----------
    merging : the mappings that others are merged into
    scalars : all single values that are no keys
    """

    root: AnyNode
    anchored: list[AnyNode]
    aliases: list[TextAlias]
    merging: list[TextMapping] = field(default_factory=list)
    scalars: list[TextScalar] = field(default_factory=list)

    def target(self, alias: TextAlias) -> AnyNode:
        """What an alias refers to: the last node before it that has the anchor."""
        return next(node for node in reversed(self.anchored) if node.anchor == alias.name and node.start < alias.start)

    def resolved(self, node: AnyNode) -> AnyNode:
        """The node itself, or what it refers to."""
        return self.target(node) if isinstance(node, TextAlias) else node

    def users(self, node: AnyNode) -> list[TextAlias]:
        """The aliases of a node."""
        return [alias for alias in self.aliases if node.anchor == alias.name and self.target(alias) is node]

    def is_shared(self, node: AnyNode, key: str | int) -> bool:
        """Whether what a node has under a key is also somewhere else, through an alias of the node or by being merged."""
        merged = [each for each in self.merging if any(other is node for other in self.merged(each))]
        return len(self.users(node)) > len(merged) or any(each.entry(str(key)) is None for each in merged)

    def value(self, mapping: TextMapping, key: str) -> AnyNode | None:
        """The value of a key, also of one that is merged into the mapping."""
        entry = mapping.entry(key)
        if entry is not None:
            return self.resolved(entry.value)
        for other in self.merged(mapping):
            found = self.value(other, key)
            if found is not None:
                return found
        return None

    def merged(self, mapping: TextMapping) -> Iterator[TextMapping]:
        """The mappings that are merged into a mapping."""
        entry = mapping.entry(MERGE)
        if entry is None:
            return
        value = self.resolved(entry.value)
        for item in value.items if isinstance(value, TextSequence) else [value]:
            inner = self.resolved(item)
            if isinstance(inner, TextMapping):
                yield inner


@lru_cache(maxsize=16)
def read_document(text: str) -> YamlDocument:
    """The only document of a valid text; the places of many values are looked up in the same one, and searches edit it many times."""
    loader = _Loader(text)
    try:
        events = iter(loader.get_event, None)
        document = YamlDocument(TextScalar(start=0, end=0, value="", quote=""), [], [])
        for event in events:
            if isinstance(event, yaml.DocumentStartEvent):
                document.root = _node(next(events), events, document)
                break
        return document
    finally:
        loader.dispose()


def _node(event: _Event, events: Iterator[_Event], document: YamlDocument) -> AnyNode:
    start, end = event.start_mark.index, event.end_mark.index
    if isinstance(event, yaml.AliasEvent):
        alias = TextAlias(start=start, end=end, name=str(event.anchor))
        document.aliases.append(alias)
        return alias
    node: AnyNode
    if isinstance(event, yaml.ScalarEvent):
        style = event.style or ""
        quote = "|" if style in ("|", ">") else style
        node = TextScalar(start=start, end=end, anchor=event.anchor, value=event.value, quote=quote)
        document.scalars.append(node)
    elif isinstance(event, yaml.SequenceStartEvent):
        node = TextSequence(start=start, end=end, anchor=event.anchor, is_flow=bool(event.flow_style))
        for inner in events:
            if isinstance(inner, yaml.SequenceEndEvent):
                node.end = _end_of(inner) if node.is_flow else _end(node.items, end)
                break
            node.items.append(_node(inner, events, document))
    else:
        node = _mapping(event, events, document)
    if node.anchor is not None:
        document.anchored.append(node)
    return node


def _mapping(event: _Event, events: Iterator[_Event], document: YamlDocument) -> TextMapping:
    start, end = event.start_mark.index, event.end_mark.index
    node = TextMapping(start=start, end=end, anchor=event.anchor, is_flow=bool(event.flow_style))
    for key in events:
        if isinstance(key, yaml.MappingEndEvent):
            # The parser notices the end of a block only at what follows it, after comments and blank lines.
            node.end = _end_of(key) if node.is_flow else _end([entry.value for entry in node.entries], end)
            break
        value = _node(next(events), events, document)
        node.entries.append(Entry(key=key.value, start=key.start_mark.index, end=key.end_mark.index, value=value))
    if node.entry(MERGE) is not None:
        document.merging.append(node)
    return node


def _end(items: list[AnyNode], default: int) -> int:
    return items[-1].end if items else default


def _end_of(event: _Event) -> int:
    return int(event.end_mark.index)
