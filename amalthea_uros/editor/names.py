"""The names in a text: which one is at a position, and where they are defined."""

from __future__ import annotations

import re
from collections.abc import Iterator
from urllib.parse import unquote

from lsprotocol import types

from amalthea_uros._internal.records import dataclass
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.nodes import MappingNode, Node, NodePlace, ScalarNode, SequenceNode, read_nodes

#: What separates values of an `app.yaml`, and the attributes and references of a model.
_YAML_VALUE = re.compile(r"""(?:(?!:(?:\s|$)|-\s|[,\[\]{}"'#]).)+""")
_XML_WORDS = (re.compile(r'[^"<>=]+'), re.compile(r'[^\s"<>=?]+'))

#: Key of a list or a mapping -> what its members are.
_KINDS = {
    "executor": types.SymbolKind.Function,
    "tasks": types.SymbolKind.Function,
    "isrs": types.SymbolKind.Event,
    "runnables": types.SymbolKind.Method,
    "nodes": types.SymbolKind.Module,
    "subscriptions": types.SymbolKind.Method,
    "timers": types.SymbolKind.Method,
    "services": types.SymbolKind.Method,
    "clients": types.SymbolKind.Method,
    "chains": types.SymbolKind.Interface,
    "labels": types.SymbolKind.Variable,
}
#: Lists and mappings whose members have no name of their own to show, but have members.
_OUTER = ("application", "middleware")


@dataclass(frozen=True, slots=True)
class Name:
    """A candidate for the name at a position: its text, and where it is."""

    text: str
    range: types.Range


def names_at(document: TextDocument, position: types.Position) -> Iterator[Name]:
    """What may be the name at a position, longest first."""
    line = document.lines[position.line] if position.line < len(document.lines) else ""
    column = document.column(position)
    for pattern in (_YAML_VALUE,) if document.is_description else _XML_WORDS:
        for match in pattern.finditer(line):
            text = match[0].strip()
            start = match.start() + match[0].find(text)
            if start <= column <= start + len(text) and text:
                where = types.Range(
                    document.position(position.line, start), document.position(position.line, start + len(text))
                )
                yield Name(text if document.is_description else unquote(text), where)


def symbols_of(document: TextDocument) -> list[types.DocumentSymbol]:
    """The objects of an `app.yaml` by their names; none while the text is not valid YAML."""
    if not document.is_description:
        return []
    try:
        node, _, _ = read_nodes(document.path, document.text)
    except ReadError:
        return []
    return list(_symbols(document, node))


def definition_of(document: TextDocument, position: types.Position) -> types.Location | None:
    """Where the name at a position is defined."""
    defined = {symbol.name: symbol for symbol in _flat(symbols_of(document))}
    for name in names_at(document, position):
        if name.text in defined:
            return types.Location(document.uri, defined[name.text].selection_range)
    return None


def _flat(symbols: list[types.DocumentSymbol]) -> Iterator[types.DocumentSymbol]:
    for symbol in symbols:
        yield symbol
        yield from _flat(list(symbol.children or ()))


def _symbols(document: TextDocument, node: Node) -> Iterator[types.DocumentSymbol]:
    if not isinstance(node, MappingNode):
        return
    for key, value in node.items.items():
        if key in _OUTER:
            yield from _symbols(document, value)
        elif key == "labels" and isinstance(value, MappingNode):
            yield from (_symbol(document, key, name, value.keys[name], item) for name, item in value.items.items())
        elif key in _KINDS:
            for item in value.items if isinstance(value, SequenceNode) else [value]:
                name = item.items.get("name") if isinstance(item, MappingNode) else None
                if isinstance(name, ScalarNode) and str(name.value or "").strip():
                    yield _symbol(document, key, str(name.value), name.place, item)


def _symbol(document: TextDocument, key: str, name: str, place: NodePlace, node: Node) -> types.DocumentSymbol:
    selection = types.Range(
        document.position(place.line, place.column), document.position(place.line, place.column + len(name))
    )
    # An item of an alias is elsewhere than its anchor.
    start = min(node.place.line, place.line)
    end = max(_last_line(node), place.line)
    return types.DocumentSymbol(
        name=name,
        kind=_KINDS[key],
        range=types.Range(types.Position(start, 0), document.position(end, len(document.lines[end]))),
        selection_range=selection,
        children=list(_symbols(document, node)),
    )


def _last_line(node: Node) -> int:
    inner = list(node.items.values()) if isinstance(node, MappingNode) else node.items if isinstance(node, SequenceNode) else []
    return max([node.place.line, *map(_last_line, inner)])
