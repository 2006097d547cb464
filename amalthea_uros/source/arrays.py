"""Arrays and structures that are initialised with lists: how many elements they have, and what is at a place of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from amalthea_uros.source.syntax import descendants, text_of

if TYPE_CHECKING:
    from tree_sitter import Node

#: Classes of C++ that are arrays of a fixed length: their last argument.
_TEMPLATES = ("array",)
#: Functions and macros that count the elements of an array; those of Zephyr the bytes of a stack.
_COUNTS = ("std::size", "size", "ARRAY_SIZE", "RCL_ARRAY_SIZE", "LENGTH", "K_THREAD_STACK_SIZEOF", "K_KERNEL_STACK_SIZEOF")
#: Types of the elements of stacks and their sizes in bytes, on controllers with 32 bits.
WIDTHS = {"uint8_t": 1, "char": 1, "uint32_t": 4, "StackType_t": 4, "uint64_t": 8}


def declared_sizes(node: Node) -> dict[str, str]:
    """The arrays that a declaration declares -> the expressions of their lengths; "" for those that follow from a list."""
    sizes: dict[str, str] = {}
    kind = node.child_by_field_name("type")
    length = _template_length(kind) if kind is not None else None
    for declarator in node.children_by_field_name("declarator"):
        inner: Node | None = declarator
        outermost: str | None = length
        while inner is not None and inner.type not in ("identifier", "field_identifier"):
            if inner.type == "array_declarator":
                # The innermost one around the name is the first dimension.
                size = inner.child_by_field_name("size")
                outermost = text_of(size) if size is not None else ""
            inner = inner.child_by_field_name("declarator") or next(iter(inner.named_children), None)
        if inner is not None and outermost is not None:
            sizes[text_of(inner)] = outermost
    return sizes


def _template_length(kind: Node) -> str | None:
    if kind.type.endswith("_specifier"):
        return None  # templates in the body of a class are those of its members
    template = next((each for each in descendants(kind) if each.type == "template_type"), None)
    name = template.child_by_field_name("name") if template is not None else None
    arguments = template.child_by_field_name("arguments") if template is not None else None
    if name is None or arguments is None or text_of(name) not in _TEMPLATES or arguments.named_child_count != 2:
        return None
    return text_of(arguments.named_children[1])


def elements_of(values: Node) -> list[Node]:
    """The elements of a list; one more pair of braces around all of them does not count."""
    elements = [child for child in values.named_children if child.type != "comment"]
    if len(elements) == 1 and elements[0].type == "initializer_list" and values.parent is not None:
        inner = [child for child in elements[0].named_children if child.type != "comment"]
        if inner and all(each.type == "initializer_list" for each in inner):
            return inner
    return elements


def members_of(values: Node, order: Sequence[str]) -> Mapping[str, Node]:
    """The values that a list gives the members of a structure, by their names, or by their positions in the structure."""
    elements = [child for child in values.named_children if child.type != "comment"]
    found: dict[str, Node] = {}
    for pair in elements:
        designator, value = pair.child_by_field_name("designator"), pair.child_by_field_name("value")
        if pair.type == "initializer_pair" and designator is not None and value is not None:
            found.setdefault(text_of(designator).lstrip("."), value)
    is_by_name = any(each.type == "initializer_pair" for each in elements)
    return found if is_by_name else dict(zip(order, elements, strict=False))


def counted_array(node: Node) -> Node | None:
    """The array whose length an expression is: `a.size()`, `std::size(a)`, `sizeof(a) / sizeof(a[0])` or `sizeof a / sizeof *a`."""
    if node.type == "call_expression":
        function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
        given = list(arguments.named_children) if arguments is not None else []
        if function is not None and function.type == "field_expression" and not given:
            field = function.child_by_field_name("field")
            return function.child_by_field_name("argument") if field is not None and text_of(field) == "size" else None
        is_count = function is not None and text_of(function) in _COUNTS
        return given[0] if is_count and len(given) == 1 else None
    left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
    whole, first = (sized_operand(each) if each is not None else None for each in (left, right))
    if whole is None or first is None:
        return None
    base = first.child_by_field_name("argument") if first.type in ("subscript_expression", "pointer_expression") else None
    return whole if base is not None and text_of(base) == text_of(whole) else None


def sized_operand(node: Node) -> Node | None:
    """The operand of `sizeof`."""
    if node.type != "sizeof_expression":
        return None
    inner: Node | None = node.child_by_field_name("value")
    while inner is not None and inner.type == "parenthesized_expression":
        inner = next(iter(inner.named_children), None)
    return inner
