"""Syntax trees of C and C++, by tree-sitter, which is optional, and what the preprocessor leaves of them.

Branches that are certainly not compiled are skipped, of all others both are read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.source.files import SourceFile

if TYPE_CHECKING:
    from tree_sitter import Node, Parser


#: Levels of syntax trees; compilers guarantee 63 of blocks, structures and parentheses (C99, section 5.2.4.1).
_MAX_DEPTH = 1000


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


def is_too_deep(root: Node) -> bool:
    """Whether a tree is nested deeper than that of a program: what asks for the outer nodes of each node would take hours."""
    cursor, depth = root.walk(), 0
    while depth <= _MAX_DEPTH:
        if cursor.goto_first_child():
            depth += 1
            continue
        while not cursor.goto_next_sibling():
            if not cursor.goto_parent():
                return False
            depth -= 1
    return True


def parse_expression(text: str, is_c: bool = True) -> Node | None:
    """The syntax tree of an expression, e.g. of the text of a macro; None if it is none."""
    root = _parser(is_c).parse(f"int x = {text}\n;".encode()).root_node
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


def called(node: Node) -> tuple[str, list[Node]]:
    """The name of the function that a call calls, as it is written, and the arguments."""
    function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
    given = [child for child in arguments.named_children if child.type != "comment"] if arguments is not None else []
    return (text_of(function) if function is not None else ""), given


if TYPE_CHECKING:
    from tree_sitter import Node

_IFS = ("preproc_if", "preproc_ifdef", "preproc_elif", "preproc_elifdef")
_ELSES = ("preproc_elif", "preproc_elifdef", "preproc_else")

Evaluate = Callable[["Node"], int | None]


def is_conditional(node: Node) -> bool:
    """Whether a node is an `#if` or what follows one."""
    return node.type in _IFS or node.type == "preproc_else"


def branches(node: Node, defined: Mapping[str, object], evaluate: Evaluate) -> Iterator[tuple[Node, bool]]:
    """What may be compiled of a conditional node, and whether that depends on something unknown.

    Parameters
    ----------
    defined : macros that the sources define
    evaluate : the value of an expression, None if it is unknown
    """
    truth = True if node.type == "preproc_else" else _truth(node, defined, evaluate)
    alternative = node.child_by_field_name("alternative")
    head = {child.id for name in ("name", "condition") for child in node.children_by_field_name(name)}
    if truth is not False:
        for child in node.named_children:
            if child.id not in head and child.type not in _ELSES:
                yield child, truth is None
    if truth is not True and alternative is not None:
        for child, unknown in branches(alternative, defined, evaluate):
            yield child, unknown or truth is None


def _truth(node: Node, defined: Mapping[str, object], evaluate: Evaluate) -> bool | None:
    name = node.child_by_field_name("name")
    if name is not None:
        # What the sources do not define, the build may.
        known = True if text_of(name) in defined else None
        if node.children[0].type not in ("#ifndef", "#elifndef"):
            return known
        return True if _defines(node, text_of(name)) else None if known is None else False
    condition = node.child_by_field_name("condition")
    return None if condition is None else _holds(condition, defined, evaluate)


def _defines(node: Node, name: str) -> bool:
    """Whether a macro is defined under the condition that it is not: a guard against reading a header twice, or a default."""
    return any(
        child.type == "preproc_def" and (own := child.child_by_field_name("name")) is not None and text_of(own) == name
        for child in node.named_children
    )


def _holds(node: Node, defined: Mapping[str, object], evaluate: Evaluate) -> bool | None:
    if node.type == "preproc_defined":
        names = [text_of(child) for child in node.named_children]
        return True if names and names[0] in defined else None
    if node.type == "parenthesized_expression" and node.named_child_count == 1:
        return _holds(node.named_children[0], defined, evaluate)
    if node.type == "unary_expression" and text_of(node).startswith("!"):
        inner = _holds(node.named_children[0], defined, evaluate)
        return None if inner is None else not inner
    if node.type == "binary_expression" and text_of(node.children[1]) in ("&&", "||"):
        both = [_holds(child, defined, evaluate) for child in node.named_children]
        decisive = text_of(node.children[1]) == "||"
        if decisive in both:
            return decisive
        return None if None in both else not decisive
    value = evaluate(node)
    return None if value is None else value != 0
