"""Values as YAML in flow style, which is valid wherever a value can be."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.description.text_nodes import (
    AnyNode,
    Entry,
    TextAlias,
    TextMapping,
    TextScalar,
    TextSequence,
    YamlDocument,
    read_document,
)
from amalthea_uros.errors import InvalidArgumentError

#: What can be written: text as it is read again, numbers, lists and mappings.
Value: TypeAlias = "str | int | Sequence[Value] | Mapping[str, Value]"

#: Text that means itself without quotes, in blocks and in flow style.
_PLAIN = re.compile(r"(?:[A-Za-z_/.]|\d+(?:\.\d+)? ?[A-Za-z])[\w./ -]*(?<! )", re.ASCII)
_WORDS = ("null", "true", "false", "~")


def rendered(value: Value, quote: str = "") -> str:
    """The YAML text of a value.

    Parameters
    ----------
    quote : that the text had before; it is kept
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return _text(value, quote)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_text(key, '')}: {rendered(item)}" for key, item in value.items()) + "}"
    return "[" + ", ".join(rendered(item) for item in value) + "]"


def _text(text: str, quote: str) -> str:
    if quote == '"' and text.isprintable() and not {'"', "\\"} & set(text):
        return f'"{text}"'
    if quote == "'" or not _PLAIN.fullmatch(text) or text.lower() in _WORDS:
        return "'" + text.replace("'", "''") + "'"
    return text


#: Keys of mappings and indices of lists, from the root to a value.
Path: TypeAlias = tuple[str | int, ...]

#: Keys whose value may be written as a plain one -> the key that the plain value has in the mapping.
_SHORTHANDS = {
    "hardware": "platform",
    "execution_time": "base",
    "per_message": "fixed",
    "sporadic": "min",
    "interrupt": "execution_time",
}
#: Keys after which a new one is added, the first that a mapping has.
_NEIGHBOURS = ("task_period", "period", "rate", "interval", "name", "platform")


@dataclass(frozen=True, slots=True)
class _Patch:
    """Characters that replace others."""

    start: int
    end: int
    text: str


def with_value(text: str, path: Path, value: Value, instead_of: str | None = None) -> str:
    """The text in which a value is another one.

    Parameters
    ----------
    instead_of : a key beside the last one of the path, in whose place it is written, e.g. `rate` for `period`

    Raises
    ------
    InvalidArgumentError : the value is part of something that several places share.
    """
    patches = _Patcher(text, read_document(text)).patches(path, value, instead_of)
    for patch in sorted(patches, key=lambda patch: patch.start, reverse=True):
        text = text[: patch.start] + patch.text + text[patch.end :]
    return text


def with_comment(text: str, path: Path, subject: str, comment: str) -> str:
    """The text with a comment on a line of its own above the line of a value.

    Parameters
    ----------
    subject : how the comment begins; one that begins so and is there already is replaced
    """
    newline = newline_of(text)
    lines = text.split(newline)
    row = text.count("\n", 0, _start_of_line(text, path))
    new = lines[row][: len(lines[row]) - len(lines[row].lstrip())] + f"# {subject} {comment}"
    for above in range(row - 1, -1, -1):
        line = lines[above].strip()
        if not line.startswith("#"):
            break
        if line.startswith(f"# {subject} "):
            lines[above] = new
            return newline.join(lines)
    return newline.join([*lines[:row], new, *lines[row:]])


def _start_of_line(text: str, path: Path) -> int:
    """Where the line of a value starts; if this is within a text of several lines, where the line with the start of that is."""
    document = read_document(text)
    place, _ = _found(document, path)
    start = text.rfind("\n", 0, place.start) + 1
    for scalar in reversed(document.scalars):
        if scalar.start < start < scalar.end:
            start = text.rfind("\n", 0, scalar.start) + 1
    return start


def newline_of(text: str) -> str:
    """How the lines of a text end."""
    first = text.find("\n")
    return "\r\n" if first > 0 and text[first - 1] == "\r" else "\n"


def line_of(text: str, path: Path) -> int:
    """The line of a value, counted from 1; of one that is not there, the line of what it would be in."""
    place, _ = _found(read_document(text), path)
    return text.count("\n", 0, place.start) + 1


def value_text(text: str, path: Path) -> str | None:
    """The text of a value as it is, None if it is not there."""
    place, is_there = _found(read_document(text), path)
    node = place.value if isinstance(place, Entry) else place
    return text[node.start : node.end].strip() if is_there else None


def has_list(text: str, path: Path, length: int) -> bool:
    """Whether the text has a list of some length at a path."""
    node = _node_at(text, path)
    return isinstance(node, TextSequence) and len(node.items) == length


def has_mapping(text: str, path: Path) -> bool:
    """Whether the text has a mapping at a path."""
    return isinstance(_node_at(text, path), TextMapping)


def _node_at(text: str, path: Path) -> AnyNode | None:
    """The node at a path, None if it is not there."""
    document = read_document(text)
    place, is_there = _found(document, path)
    return document.resolved(place.value if isinstance(place, Entry) else place) if is_there else None


def _found(document: YamlDocument, path: Path) -> tuple[Entry | AnyNode, bool]:
    """The place of a value, and whether it is there: otherwise it is the place of what it would be in."""
    place: Entry | AnyNode = document.root
    for key in path:
        node = document.resolved(place.value if isinstance(place, Entry) else place)
        inner = _inner(node, key)
        if inner is None:
            return place, False
        place = inner
    return place, True


def _inner(node: AnyNode, key: str | int) -> Entry | AnyNode | None:
    """What a mapping or a list has under a key or an index."""
    if isinstance(node, TextSequence) and isinstance(key, int):
        return node.items[key]
    return node.entry(str(key)) if isinstance(node, TextMapping) else None


@dataclass(frozen=True, slots=True)
class _Patcher:
    """Finds out which characters a change touches."""

    text: str
    document: YamlDocument

    def patches(self, path: Path, value: Value, instead_of: str | None) -> Iterator[_Patch]:
        """The patches that give a value to a path."""
        node = self.document.root
        for depth, key in enumerate(path):
            rest = path[depth + 1 :]
            if isinstance(node, TextAlias):
                raise _shared(node.name)
            if isinstance(node, TextScalar):
                yield self._expanded(node, _shorthand(path[:depth]), _nested((key, *rest), value))
                return
            if node.anchor is not None and self.document.is_shared(node, key):
                raise _shared(node.anchor)
            inner = _inner(node, key)
            if isinstance(node, TextMapping) and inner is None:
                if rest and self.document.value(node, str(key)) is not None:
                    raise _shared("<<")  # the entry would hide the other keys of the one that is merged
                yield self._added(node, str(key), _nested(rest, value), instead_of if not rest else None)
                return
            assert inner is not None
            if not rest:
                yield from self._replaced(inner, value)
                return
            node = inner.value if isinstance(inner, Entry) else inner

    def _expanded(self, node: TextScalar, key: str, more: Value) -> _Patch:
        """A plain value, which has a key in the mapping, as a mapping with more."""
        assert isinstance(more, Mapping)
        if more.keys() == {key}:
            return _Patch(node.start, node.end, rendered(more[key], node.quote))
        plain = {key: node.value} if node.value else {}
        return _Patch(node.start, node.end, rendered({**plain, **more}))

    def _added(self, mapping: TextMapping, key: str, value: Value, instead_of: str | None) -> _Patch:
        """A new entry of a mapping."""
        new = f"{rendered(key)}: {rendered(value)}"
        former = mapping.entry(instead_of) if instead_of else None
        if former is not None:
            return _Patch(former.start, former.value.end, new)
        neighbour = self._neighbour(mapping)
        if mapping.is_flow:
            if neighbour is None:
                after_brace = self.text.index("{", mapping.start) + 1
                return _Patch(after_brace, after_brace, new)
            return _Patch(neighbour.value.end, neighbour.value.end, f", {new}")
        first = mapping.entries[0]
        indentation = " " * (first.start - self.text.rfind("\n", 0, first.start) - 1)
        newline = newline_of(self.text)
        if neighbour is None:
            return _Patch(first.start, first.start, new + newline + indentation)
        end = self._end_of_line(neighbour.value.end)
        return _Patch(end, end, newline + indentation + new)

    def _neighbour(self, mapping: TextMapping) -> Entry | None:
        """The entry after which a new one is added: in a block, one that ends on its line."""
        known = [entry for entry in mapping.entries if mapping.is_flow or "\n" not in self.text[entry.start : entry.value.end]]
        by_name = [entry for key in _NEIGHBOURS for entry in known if entry.key == key]
        return next(iter([*by_name, *reversed(known)]), None)

    def _end_of_line(self, position: int) -> int:
        end = self.text.find("\n", position)
        if end < 0:
            return len(self.text)
        return end - 1 if self.text[end - 1] == "\r" else end

    def _replaced(self, place: Entry | AnyNode, value: Value) -> Iterator[_Patch]:
        """Another value for one that is there."""
        node = place.value if isinstance(place, Entry) else place
        users = self.document.users(node)
        if users and isinstance(node, TextScalar):
            # The others keep the value: the first alias becomes the anchor.
            yield _Patch(users[0].start, users[0].end, self.text[node.start : node.end])
            yield _Patch(node.start, node.end, rendered(value, node.quote))
        elif users:
            raise _shared(str(node.anchor))
        elif isinstance(node, TextMapping) and isinstance(value, Mapping) and _is_same_form(node, value):
            for entry in node.entries:
                yield from self._replaced(entry, value[entry.key])
        elif isinstance(node, TextMapping | TextSequence) and not node.is_flow and isinstance(place, Entry):
            start = self.text.find(":", place.end) + 1
            has_comment = "#" in self.text[start : node.start]
            yield _Patch(node.start if has_comment else start, node.end, ("" if has_comment else " ") + rendered(value))
        else:
            anchor = f"&{node.anchor} " if node.anchor else ""
            quote = node.quote if isinstance(node, TextScalar) else ""
            ending = newline_of(self.text) if quote == "|" else ""
            yield _Patch(node.start, node.end, anchor + rendered(value, quote) + ending)


def _shorthand(path: Path) -> str:
    """The key that a plain value has in the mapping; each label may be one."""
    return "size" if path[0] == "labels" else _SHORTHANDS[str(path[-1])]


def _is_same_form(node: TextMapping, value: Mapping[str, Value]) -> bool:
    """Whether a mapping has the keys of a value, and plain values."""
    scalars = {entry.key for entry in node.entries if isinstance(entry.value, TextScalar | TextAlias)}
    return scalars == value.keys() and len(node.entries) == len(value)


def _nested(path: Path, value: Value) -> Value:
    """A value in the mappings of a path."""
    for key in reversed(path):
        value = {str(key): value}
    return value


def _shared(anchor: str) -> InvalidArgumentError:
    what = "merged with '<<'" if anchor == "<<" else f"shared through the anchor &{anchor}"
    return InvalidArgumentError(f"the value is part of a mapping that is {what}; write it out in this place first")
