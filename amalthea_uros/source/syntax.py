"""Syntax trees of C and C++, by tree-sitter, which is optional."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.source.files import SourceFile

if TYPE_CHECKING:
    from tree_sitter import Node, Parser


@cache
def _parser(is_c: bool) -> Parser:
    try:
        from tree_sitter import Language, Parser

        module = import_module("tree_sitter_c" if is_c else "tree_sitter_cpp")
    except ImportError:
        advice = "Install them: pip install 'amuros[code]'"
        raise ReadError(
            [
                Finding(
                    "IMP002",
                    Severity.ERROR,
                    "reading source code needs tree-sitter, tree-sitter-c and tree-sitter-cpp",
                    None,
                    advice,
                )
            ]
        ) from None
    return Parser(Language(module.language()))


def parse(file: SourceFile) -> Node:
    """The syntax tree of a file; what is not understood is a node of type ERROR in it.

    Raises
    ------
    ReadError : the parsers are not installed.
    """
    return _parser(file.is_c).parse(file.text).root_node


def parse_expression(text: str) -> Node | None:
    """The syntax tree of an expression, e.g. of the text of a macro; None if it is none."""
    root = _parser(True).parse(f"int x = {text}\n;".encode()).root_node
    if root.has_error or root.named_child_count != 1 or (declaration := root.named_child(0)) is None:
        return None
    declarator = declaration.child_by_field_name("declarator")
    return declarator.child_by_field_name("value") if declarator is not None else None


def text_of(node: Node) -> str:
    """The text of a node."""
    return (node.text or b"").decode("utf-8", "replace")


def location_of(file: SourceFile, node: Node) -> Location:
    """Where a node begins."""
    return file.location(node.start_point.row, node.start_point.column)


def descendants(node: Node) -> Iterator[Node]:
    """A node and all in it, in the order of the text, without recursion: trees of hostile files are deep."""
    waiting = [node]
    while waiting:
        current = waiting.pop()
        yield current
        waiting.extend(reversed(current.named_children))
