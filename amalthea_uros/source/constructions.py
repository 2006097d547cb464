"""Objects of C++ that are made with arguments."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.source.syntax import text_of

if TYPE_CHECKING:
    from tree_sitter import Node

#: Functions that make an object of the class between their brackets.
MAKERS = ("make_unique", "make_shared")


def made_class(node: Node) -> str:
    """The class of an object that is made: `Motor(1)`, `new Motor(1)` or `std::make_unique<Motor>(1)`; "" for other expressions."""
    kind = node.child_by_field_name({"new_expression": "type", "call_expression": "function"}.get(node.type, "name"))
    if node.type == "template_function":
        arguments = node.child_by_field_name("arguments")
        is_maker = kind is not None and text_of(kind) in MAKERS and arguments is not None
        kind = next(iter(arguments.named_children), None) if is_maker and arguments is not None else None
    elif kind is not None and kind.type in ("qualified_identifier", "template_function") and node.type == "call_expression":
        inner = kind.child_by_field_name("name") if kind.type == "qualified_identifier" else kind
        if inner is not None and inner.type == "template_function":
            return made_class(inner)
    elif node.type not in ("new_expression", "call_expression"):
        return ""
    return text_of(kind).partition("<")[0].rpartition("::")[2] if kind is not None else ""


def arguments_of(node: Node) -> list[Node]:
    """The arguments that an object is made with; none if an expression does not make one."""
    given = node if node.type in ("argument_list", "initializer_list") else node.child_by_field_name("arguments")
    return [child for child in given.named_children if child.type != "comment"] if given is not None else []
