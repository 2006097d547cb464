"""YAML text -> nodes with their locations.

The text is untrusted: its size, its depth and what its aliases expand to are limited, tags are refused. Scalars follow the core
schema of YAML 1.2 (`on` and `no` are text, `1:30` is not a number), but decimals stay text. All errors that do not stop the parser are
reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeAlias

import yaml

from amalthea_uros._internal.limits import ADVICE, DESCRIPTION_VALUES
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError

MAX_DEPTH = 40
#: Further errors are not reported in one run.
MAX_FINDINGS = 100

#: As one writes numbers that mean the same to every reader: 010 is ten in YAML 1.2 and eight in YAML 1.1, so it is text.
_INTEGER = re.compile(r"0|-?[1-9]\d{0,29}", re.ASCII)
_WORDS = {"": None, "~": None, "null": None, "Null": None, "NULL": None} | {
    word: value for value, name in ((True, "true"), (False, "false")) for word in (name, name.title(), name.upper())
}

_MERGE = "<<"
_TABS = "tabs cannot be used for indentation"

_Parser: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
#: The events and marks of libyaml and of PyYAML's own parser have no common type.
_Event: TypeAlias = Any


@dataclass(frozen=True, slots=True)
class NodePlace:
    """Where a node begins; line and column are counted from 0."""

    line: int
    column: int


@dataclass(frozen=True, slots=True)
class ScalarNode:
    """A single value."""

    place: NodePlace
    value: str | int | bool | None


@dataclass(frozen=True, slots=True)
class SequenceNode:
    """A list of nodes."""

    place: NodePlace
    items: list[Node]


@dataclass(frozen=True, slots=True)
class MappingNode:
    """Nodes by key."""

    place: NodePlace
    items: dict[str, Node]
    keys: dict[str, NodePlace]


Node: TypeAlias = ScalarNode | SequenceNode | MappingNode


@dataclass(frozen=True, slots=True)
class YamlText:
    """The text of a file, to show lines of it."""

    path: Path
    lines: list[str]

    def location(self, place: NodePlace) -> Location:
        """A place as a location with the text of its line."""
        text = self.lines[place.line] if place.line < len(self.lines) else ""
        return Location(self.path, place.line + 1, place.column + 1, text)


def read_nodes(path: Path, text: str) -> tuple[Node, YamlText, list[Finding]]:
    """The content of a YAML document, and the errors in it that do not stop the parser.

    Raises
    ------
    ReadError : the text is not a YAML document, or exceeds a limit.
    """
    source = YamlText(path, text.split("\n"))
    reader = _NodeReader(source)
    try:
        node = reader.document(text)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        if "maximum nesting depth" in (error.problem or ""):
            # Newer versions of libyaml have a limit of their own, above that of a description.
            raise reader.too_deep(mark) from None
        raise reader.stop("YML001", _reason(error, source), mark) from None
    except yaml.reader.ReaderError as error:
        raise ReadError([_unreadable(source, text, error)]) from None
    return node, source, reader.findings


def _reason(error: yaml.MarkedYAMLError, source: YamlText) -> str:
    problem, context = error.problem or "", error.context or ""
    mark = error.problem_mark
    if "tab character that violates indentation" in problem:
        return f"not valid YAML: {_TABS}"
    if mark is not None and "cannot start any token" in problem:
        character = source.lines[mark.line][mark.column : mark.column + 1]
        problem = _TABS if character == "\t" else f"a value cannot start with {character!r} without quotes"
        context = ""
    return f"not valid YAML: {problem}{f' ({context})' if context else ''}"


def _unreadable(source: YamlText, text: str, error: yaml.reader.ReaderError) -> Finding:
    match = re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufffe\uffff]", text)
    if match is None:
        return Finding("YML001", Severity.ERROR, f"not valid YAML: {error.reason}", Location(source.path))
    line = text.count("\n", 0, match.start())
    place = NodePlace(line, match.start() - text.rfind("\n", 0, match.start()) - 1)
    location = Location(source.path, place.line + 1, place.column + 1)
    return Finding("YML001", Severity.ERROR, f"not valid YAML: the character U+{ord(match[0]):04X} is not allowed", location)


class _NodeReader:
    def __init__(self, source: YamlText) -> None:
        self.source = source
        self.findings: list[Finding] = []
        self.anchors: dict[str, Node] = {}
        self.count = 0

    def document(self, text: str) -> Node:
        """The only document of the text."""
        parser = _Parser(text)
        try:
            events = iter(parser.get_event, None)
            for event in events:
                if isinstance(event, yaml.DocumentStartEvent):
                    break
            else:
                return ScalarNode(NodePlace(0, 0), None)
            node = self.node(next(events), events, 1)
            next(events)
            extra = next(events)
            if isinstance(extra, yaml.DocumentStartEvent):
                raise self.stop("YML001", "the file contains several YAML documents, expected one", extra.start_mark)
            return node
        finally:
            parser.dispose()

    def node(self, event: _Event, events: Iterator[_Event], depth: int) -> Node:
        """The node that begins with an event."""
        self.check_depth(depth, event.start_mark)
        if isinstance(event, yaml.AliasEvent):
            return self.alias(event, depth)
        if getattr(event, "tag", None) not in (None, "!"):
            raise self.stop("YML001", "tags are not allowed", event.start_mark, "Write the plain value.")
        place = _place(event.start_mark)
        node: Node
        if isinstance(event, yaml.ScalarEvent):
            node = ScalarNode(place, _value(event))
        elif isinstance(event, yaml.SequenceStartEvent):
            node = SequenceNode(place, self.items(events, depth))
        else:
            node = self.mapping(place, events, depth)
        self.tally(event.start_mark)
        if event.anchor:
            self.anchors[event.anchor] = node
        return node

    def items(self, events: Iterator[_Event], depth: int) -> list[Node]:
        """The nodes of a sequence."""
        found: list[Node] = []
        for event in events:
            if isinstance(event, yaml.SequenceEndEvent):
                break
            found.append(self.node(event, events, depth + 1))
        return found

    def mapping(self, place: NodePlace, events: Iterator[_Event], depth: int) -> MappingNode:
        """The nodes of a mapping; of a duplicate key the first value is used."""
        found = MappingNode(place, {}, {})
        inherited: list[MappingNode] = []
        for event in events:
            if isinstance(event, yaml.MappingEndEvent):
                break
            if not isinstance(event, yaml.ScalarEvent):
                raise self.stop("YML001", "a key must be a plain string", event.start_mark)
            value = self.node(next(events), events, depth + 1)
            where = _place(event.start_mark)
            if event.value == _MERGE:
                inherited += self.merged(value, event.start_mark)
                continue
            if event.value in found.items:
                self.second(event.value, found.keys[event.value], where)
                continue
            found.items[event.value] = value
            found.keys[event.value] = where
        # Keys of the mapping itself come first, then those of earlier mappings: https://yaml.org/type/merge.html
        for other in inherited:
            for key, item in other.items.items():
                found.keys.setdefault(key, other.keys[key])
                found.items.setdefault(key, item)
        return found

    def merged(self, value: Node, mark: Any) -> list[MappingNode]:
        """The mappings that a merge key names."""
        named = value.items if isinstance(value, SequenceNode) else [value]
        mappings = [item for item in named if isinstance(item, MappingNode)]
        if len(mappings) < len(named):
            message = f"{_MERGE!r} merges mappings, but its value is something else"
            raise self.stop(
                "YML001", message, mark, "Write an alias of a mapping, e.g. <<: *defaults, or a list of such aliases."
            )
        return mappings

    def second(self, key: str, first: NodePlace, where: NodePlace) -> None:
        """Report a duplicate key."""
        message = f"duplicate key {key!r} (first defined on line {first.line + 1})"
        self.findings.append(Finding("YML003", Severity.ERROR, message, self.source.location(where), "Remove one of them."))
        if len(self.findings) == MAX_FINDINGS:
            raise ReadError(self.findings)

    def alias(self, event: _Event, depth: int) -> Node:
        """The node that an alias refers to; it is counted again with everything in it."""
        node = self.anchors.get(event.anchor)
        if node is None:
            raise self.stop(
                "YML001", f"undefined alias *{event.anchor}: no complete anchor &{event.anchor} before it", event.start_mark
            )
        for level, _ in _walk(node, depth):
            self.check_depth(level, event.start_mark)
            self.tally(event.start_mark)
        return node

    def check_depth(self, depth: int, mark: Any) -> None:
        """Stop at the limit of nesting."""
        if depth > MAX_DEPTH:
            raise self.too_deep(mark)

    def too_deep(self, mark: Any) -> ReadError:
        """The error of content that is nested too deep."""
        return self.stop("YML002", f"the content is nested more than {MAX_DEPTH} levels deep", mark)

    def tally(self, mark: Any) -> None:
        """Count a node, and stop at the limit."""
        self.count += 1
        if self.count > DESCRIPTION_VALUES:
            message = f"the content has more than {DESCRIPTION_VALUES:,} values, including expanded aliases"
            raise self.stop("YML002", message, mark, ADVICE)

    def stop(self, rule: str, message: str, mark: Any, help_text: str = "") -> ReadError:
        """The error that stops reading, together with the findings so far."""
        location = self.source.location(_place(mark)) if mark else Location(self.source.path)
        return ReadError([*self.findings, Finding(rule, Severity.ERROR, message, location, help_text)])


def _place(mark: Any) -> NodePlace:
    return NodePlace(mark.line, mark.column)


def _value(event: _Event) -> str | int | bool | None:
    text: str = event.value
    is_plain, _ = event.implicit
    if not is_plain:
        return text
    if text in _WORDS:
        return _WORDS[text]
    return int(text) if _INTEGER.fullmatch(text) else text


def _walk(node: Node, depth: int) -> Iterator[tuple[int, Node]]:
    """A node and everything in it, with their depths."""
    yield depth, node
    if not isinstance(node, ScalarNode):
        for inner in node.items.values() if isinstance(node, MappingNode) else node.items:
            yield from _walk(inner, depth + 1)


def plain(node: Node) -> Any:
    """The node as dicts, lists and values."""
    match node:
        case ScalarNode():
            return node.value
        case SequenceNode():
            return [plain(item) for item in node.items]
        case MappingNode():
            return {key: plain(item) for key, item in node.items.items()}
