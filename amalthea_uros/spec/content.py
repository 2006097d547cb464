"""The content of an `app.yaml` that comes from a program instead of a file -> nodes with the paths of their keys as locations."""

from __future__ import annotations

from collections.abc import Mapping as AbstractMapping
from numbers import Integral, Real
from pathlib import Path
from typing import Any

from amalthea_uros._internal.limits import ADVICE, DESCRIPTION_VALUES
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.nodes import MAX_DEPTH, MappingNode, Node, NodePlace, ScalarNode, SequenceNode, YamlText

#: What the content as a whole is called.
WHOLE = "<content>"


class KeyPaths(YamlText):
    """The paths of all nodes, such as `application.nodes[0].name`: one for each "line"."""

    __slots__ = ()

    def location(self, place: NodePlace) -> Location:
        """The path of the keys in the place of a file."""
        return Location(Path(self.lines[place.line]))


def nodes_of(content: AbstractMapping[Any, Any]) -> tuple[Node, YamlText]:
    """The nodes of some content, and where they are.

    Raises
    ------
    ReadError : it exceeds a limit, or holds something that YAML cannot.
    """
    source = KeyPaths(Path(WHOLE), [])
    return _ContentConverter(source).node(content, "", 1), source


class _ContentConverter:
    def __init__(self, source: YamlText) -> None:
        self.paths = source.lines

    def node(self, value: object, path: str, depth: int) -> Node:
        """A value as a node."""
        if depth > MAX_DEPTH:
            raise self.stop("YML002", f"the content is nested more than {MAX_DEPTH} levels deep", path)
        if len(self.paths) == DESCRIPTION_VALUES:
            raise self.stop("YML002", f"the content has more than {DESCRIPTION_VALUES:,} values", path, ADVICE)
        place = NodePlace(len(self.paths), 0)
        self.paths.append(path or WHOLE)
        if isinstance(value, AbstractMapping):
            return self.mapping(value, place, path, depth)
        if isinstance(value, list | tuple):
            return SequenceNode(place, [self.node(item, f"{path}[{index}]", depth + 1) for index, item in enumerate(value)])
        return ScalarNode(place, self.scalar(value, path))

    def mapping(self, values: AbstractMapping[Any, Any], place: NodePlace, path: str, depth: int) -> MappingNode:
        """A mapping as a node."""
        found = MappingNode(place, {}, {})
        for key, value in values.items():
            if not isinstance(key, str):
                raise self.stop("YML001", f"a key must be a string, not {key!r}", path)
            node = self.node(value, f"{path}.{key}" if path else key, depth + 1)
            found.items[str(key)], found.keys[str(key)] = node, node.place
        return found

    def scalar(self, value: object, path: str) -> str | int | bool | None:
        """A single value; decimals are text, as in a file."""
        match value:
            case None | bool():
                return value
            case str():
                return str(value)
            case Integral():
                return int(value)
            case Real():
                return repr(float(value))
        raise self.stop("YML001", f"a value of the type {type(value).__name__} cannot be part of a description", path)

    def stop(self, rule: str, message: str, path: str, help_text: str = "") -> ReadError:
        """The error that refuses the content."""
        return ReadError([Finding(rule, Severity.ERROR, message, Location(Path(path or WHOLE)), help_text)])
