"""What expressions stand for: objects, numbers and texts, as far as they are constant."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping
from operator import eq, ge, gt, le, lt, ne
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.source.arrays import counted_array, sized_operand
from amalthea_uros.source.constructions import arguments_of, made_class
from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.program import CodeFunction, CodeProgram
from amalthea_uros.source.syntax import called, parse_expression, text_of

if TYPE_CHECKING:
    from tree_sitter import Node

#: Constants that refer to others, nested calls; more is no code that people write.
_MAX_DEPTH = 40
_GREATEST = 2**64

#: Functions and macros of rclc, FreeRTOS, Zephyr and C++ that only change the unit: value -> factor to the value.
_FACTORS = {
    **dict.fromkeys(("RCL_S_TO_NS", "RCUTILS_S_TO_NS"), 10**9),
    **dict.fromkeys(("RCL_MS_TO_NS", "RCUTILS_MS_TO_NS"), 10**6),
    **dict.fromkeys(("RCL_US_TO_NS", "RCUTILS_US_TO_NS"), 10**3),
    "K_PRIO_PREEMPT": 1,
}
#: The binding of the object whose method is called.
THIS = "this"
#: The binding of a number for the call that leads to a function, which distinguishes what it allocates in several calls.
SITE = "@"
#: Functions that allocate an object.
_ALLOCATIONS = re.compile(r"\w*(m|c)alloc|\w*allocate")
#: Functions that make a text of a value.
_TEXTS = ("String", "string", "to_string")
_FORMAT = re.compile(r"(%(?:%|\d*(?:l|ll|h|hh|z)?[dius]))")
#: Of the width of a conversion; no buffer of a name has room for more.
_WIDTH_DIGITS = 3
_COMPARISONS = {"==": eq, "!=": ne, "<": lt, "<=": le, ">": gt, ">=": ge}
_WRAPPERS = ("parenthesized_expression", "cast_expression", "pointer_expression")


@dataclass(frozen=True, slots=True, eq=False)
class Expression:
    """An expression at a place where names have a meaning.

    Attributes
    ----------
    function : the function that it is in; None outside of functions
    bindings : parameters of the function, with the arguments of its call; counters of loops, with their value in one iteration
    """

    program: CodeProgram
    node: Node
    file: SourceFile
    function: CodeFunction | None = None
    bindings: Mapping[str, Binding] = field(default_factory=dict)
    depth: int = 0

    def at(self, node: Node) -> Expression:
        """Another expression at the same place."""
        return Expression(self.program, node, self.file, self.function, self.bindings, self.depth + 1)

    @property
    def text(self) -> str:
        """As it is written, in one line."""
        return " ".join(text_of(self.node).split())

    @property
    def core(self) -> Expression:
        """Without parentheses, casts and the operators `&` and `*`."""
        node = self.node
        while node.type in _WRAPPERS:
            inner = node.child_by_field_name("value") or node.child_by_field_name("argument")
            if inner is None:
                inner = next((child for child in node.named_children if child.type != "comment"), None)
            if inner is None:
                break
            node = inner
        own = self.at(node) if node is not self.node else self
        return own._returned() if node.type == "call_expression" else own

    def _returned(self) -> Expression:
        """The value that a function returns, if it does nothing else, or the address of a variable that stays; else the call."""
        name, arguments = called(self.node)
        functions = self.program.functions.get(name.rpartition("::")[2].rpartition(".")[2].rpartition(">")[2], ())
        if len(functions) != 1 or self.depth > _MAX_DEPTH:
            return self
        function = functions[0]
        value = function.returned
        if value is None:
            return self
        bindings: dict[str, Binding] = dict(zip(function.parameters, map(self.at, arguments), strict=False))
        called_as = self.node.child_by_field_name("function")
        if (
            called_as is not None
            and (holder := called_as.child_by_field_name("argument")) is not None
            and holder.type != "this"
        ):
            bindings[THIS] = self.at(holder)
        elif THIS in self.bindings:
            bindings[THIS] = self.bindings[THIS]
        bindings[SITE] = call_site(self.file, self.node, self.bindings)
        return Expression(self.program, value, function.file, function, bindings, self.depth + 1).core

    @property
    def key(self) -> str:
        """A name for the object that it stands for, the same wherever it is used."""
        own = self.core
        if own.depth > _MAX_DEPTH:
            return own.text
        node = own.node
        if node.type == "identifier":
            return own._key_of_name(text_of(node))
        if node.type == "qualified_identifier":
            around, _, name = own.text.rpartition("::")
            owner = around.rpartition("::")[2]
            return f"{owner}::{name}" if name in self.program.members.get(owner, ()) else own._key_of_name(name)
        if node.type == "field_expression":
            holder, member = node.child_by_field_name("argument"), node.child_by_field_name("field")
            if holder is not None and member is not None:
                if holder.type == "this":
                    return own._key_of_name(text_of(member))
                if owner := own.at(holder)._only_class(text_of(member)):
                    return f"{owner}::{text_of(member)}"
                return f"{own.at(holder).key}.{text_of(member)}"
        if node.type == "subscript_expression" and (array := node.child_by_field_name("argument")) is not None:
            index = own._index()
            number = index.number if index is not None else None
            return f"{own.at(array).key}[{number if number is not None else index.text if index is not None else ''}]"
        return own.text

    @property
    def owner(self) -> str:
        """The class of the object that it is; "" if that is unknown."""
        own = self.core
        if own.depth > _MAX_DEPTH:
            return ""
        if own.node.type == "this":
            return own.function.owner if own.function is not None else ""
        bound = own.bindings.get(own.text) if own.node.type == "identifier" else None
        if isinstance(bound, Expression):
            return bound.owner
        if own.node.type == "subscript_expression":
            element = own._element()
            if element is not None and element.node.type not in ("initializer_list", "argument_list"):
                return element.owner
            array = own.node.child_by_field_name("argument")
            return own.at(array).owner if array is not None else ""
        if (made := made_class(own.node)) in self.program.members:
            return made
        return self.program.classes.get(own.text.rpartition("::")[2].rpartition(".")[2].rpartition(">")[2], "")

    def _only_class(self, member: str) -> str:
        """The class that a variable is the only object of, if it has a member, which methods call by its name; else ""."""
        own = self.core
        if own.node.type != "identifier" or own.depth > _MAX_DEPTH:
            return ""
        bound = own.bindings.get(text_of(own.node))
        if isinstance(bound, Expression):
            return bound._only_class(member)
        owner = self.program.classes.get(text_of(own.node), "")
        is_only = owner and member in self.program.members.get(owner, ()) and self.program.number_of_objects(owner) < 2
        return owner if is_only else ""

    def _index(self) -> Expression | None:
        node = self.node.child_by_field_name("index") or self.node.child_by_field_name("indices")
        if node is not None and node.type == "subscript_argument_list":
            node = next(iter(node.named_children), None)
        return self.at(node) if node is not None else None

    def _key_of_name(self, name: str) -> str:
        bound = self.bindings.get(name)
        if isinstance(bound, Expression):
            return bound.key
        if self.function is not None:
            if name in self.function.locals:
                return self._pointed(self.function.scope + name, name)
            if name in self.program.members.get(self.function.owner, ()) and self.function.owner:
                return f"{self._holder}.{name}" if self._holder else f"{self.function.owner}::{name}"
        return self._pointed(f"{self.file.path}:{name}" if (str(self.file.path), name) in self.program.statics else name, name)

    def _pointed(self, key: str, name: str) -> str:
        """The key of what a pointer or reference leads to from its declaration on, if it is one, and nothing changes it."""
        node, place = self.program.values.get(key, (None, None))
        if node is None or place is None or name in self.program.changed or self.depth > _MAX_DEPTH:
            return key
        plain = node.child_by_field_name("value") if node.type == "cast_expression" else node
        is_parameter = (
            plain is not None and isinstance(self.bindings.get(text_of(plain)), Expression) and place is self.function
        )
        if not is_parameter and (
            node.type not in ("pointer_expression", "call_expression", "subscript_expression", "new_expression")
            or (node.type == "pointer_expression" and not text_of(node).startswith("&"))
        ):
            return key
        function, file = (place, place.file) if isinstance(place, CodeFunction) else (None, place)
        bindings = self.bindings if function is self.function else {}
        if _allocates(plain) and function is not None:
            return f"{key}{SITE}{bindings.get(SITE, '')}"
        target = Expression(self.program, node, file, function, bindings, self.depth + 1)
        return target.key if target.core.node.type not in ("call_expression", "new_expression") else key

    @property
    def _holder(self) -> str:
        """The key of the object whose method it is in; "" if its class has one object only, or if that is unknown."""
        owner = self.function.owner if self.function is not None else ""
        holder = self.bindings.get(THIS)
        return holder.key if isinstance(holder, Expression) and self.program.number_of_objects(owner) > 1 else ""

    @property
    def name(self) -> str:
        """The last part of what it is called in the code."""
        own = self.core
        bound = own.bindings.get(own.text) if own.node.type == "identifier" else None
        if isinstance(bound, Expression) and own.depth <= _MAX_DEPTH:
            return bound.name
        if own.node.type == "subscript_expression" and (array := own.node.child_by_field_name("argument")) is not None:
            index = own._index()
            return f"{own.at(array).name.rstrip('_')}_{index.number if index is not None and index.number is not None else 'n'}"
        holder, member = own.node.child_by_field_name("argument"), own.node.child_by_field_name("field")
        if holder is not None and member is not None and own.at(holder).core.node.type == "subscript_expression":
            return f"{own.at(holder).name}.{text_of(member)}"
        text = own.text.replace("->", ".").replace("this.", "")
        return text.rpartition("::")[2]

    @property
    def resolved(self) -> Expression:
        """What a constant or parameter stands for, else itself."""
        own = self.core
        if own.node.type == "subscript_expression" and own.depth <= _MAX_DEPTH:
            return own._element() or own
        member = own._member() if own.depth <= _MAX_DEPTH else None
        if member is not None:
            return member
        if own.node.type not in ("identifier", "field_expression", "qualified_identifier") or own.depth > _MAX_DEPTH:
            return own
        name = text_of(own.node)
        bound = own.bindings.get(name)
        if isinstance(bound, Expression):
            return bound.resolved
        values = self.program.values
        found = values.get(own.key)
        if found is not None and name.rpartition(".")[2].rpartition(">")[2] not in self.program.changed:
            node, place = found
            function = place if isinstance(place, CodeFunction) else None
            file = place.file if isinstance(place, CodeFunction) else place
            bindings = own.bindings if function is own.function else {}
            return Expression(self.program, node, file, function, bindings, own.depth + 1).resolved
        texts = self.program.macros.get(name.rpartition("::")[2], ())
        if len(texts) == 1 and (parsed := parse_expression(next(iter(texts)))) is not None:
            return own.at(parsed).resolved
        return own

    def _element(self) -> Expression | None:
        """The element of an array that is initialised with a list, and that nothing changes."""
        array, index = self.node.child_by_field_name("argument"), self._index()
        if array is None or index is None:
            return None
        values, number = self.at(array).resolved, index.number
        elements = self.program.elements_of(values.node)
        if values.node.type != "initializer_list" or number is None or not 0 <= number < len(elements):
            return None
        return values.at(elements[number]).resolved

    def _member(self) -> Expression | None:
        """The member of a structure that is initialised with a list, and to which nothing assigns a value."""
        holder, field = self.node.child_by_field_name("argument"), self.node.child_by_field_name("field")
        if self.node.type == "identifier" or (holder is not None and holder.type == "this"):
            return self._own_member(text_of(field or self.node))
        if holder is None or field is None or text_of(field) in self.program.changed:
            return None
        values = self.at(holder).resolved
        if made := values._made(self.at(holder).owner, text_of(field)):
            return made
        if values.node.type != "initializer_list":
            return None
        base = self.at(holder).core
        while base.node.type == "subscript_expression" and (array := base.node.child_by_field_name("argument")) is not None:
            base = base.at(array).core
        value = self.program.member_of(values.node, text_of(field), self.program.classes.get(base.name, ""))
        return values.at(value).resolved if value is not None else None

    def _own_member(self, name: str) -> Expression | None:
        """The value that the object whose method it is in was made with for a member of it."""
        owner = self.function.owner if self.function is not None else ""
        if not owner or name in self.program.changed or name not in self.program.members.get(owner, ()):
            return None
        if self.function is not None and name in self.function.locals:
            return None
        holder = self.bindings.get(THIS)
        if isinstance(holder, Expression):
            return holder.resolved._made(owner, name)
        only = [variable for variable, kind in self.program.classes.items() if kind == owner]
        if len(only) != 1 or self.program.number_of_objects(owner) > 1:
            return None
        node, place = self.program.values.get(only[0], (self.node, self.file))
        file = place.file if isinstance(place, CodeFunction) else place
        return Expression(self.program, node, file, depth=self.depth + 1)._made(owner, name)

    def _made(self, owner: str, member: str) -> Expression | None:
        """The value that the constructor of a class gives a member of an object, made with the arguments of this expression."""
        constructors, given = self.program.constructors.get(owner, ()), self.program.constructed.get(owner, {}).get(member)
        if len(constructors) != 1 or given is None or self.depth > _MAX_DEPTH:
            return None
        constructor = constructors[0]
        # Where they are unknown, what does not depend on them is known all the same.
        arguments = arguments_of(self.node)
        bindings: dict[str, Binding] = dict(zip(constructor.parameters, map(self.at, arguments), strict=False))
        is_object = self.program.classes.get(member) in self.program.members
        if given.type in ("argument_list", "initializer_list") and given.named_child_count == 1 and not is_object:
            given = given.named_children[0]
        return Expression(self.program, given, constructor.file, constructor, bindings, self.depth + 1).resolved

    @property
    def length(self) -> int | None:
        """The number of elements of the array that it is; None if it is none, or that is not constant."""
        own = self.core
        if own.node.type not in ("identifier", "field_expression", "qualified_identifier") or own.depth > _MAX_DEPTH:
            return None
        name = own.text.rpartition("::")[2].rpartition(".")[2].rpartition(">")[2]
        bound = own.bindings.get(name)
        if isinstance(bound, Expression):
            return bound.length
        sizes = self.program.arrays.get(name, set())
        if len(sizes) != 1:
            return None
        size = next(iter(sizes))
        if size:
            parsed = parse_expression(size, is_c=False)
            return own.at(parsed).number if parsed is not None else None
        values = own.resolved.node
        return len(self.program.elements_of(values)) if values.type == "initializer_list" else None

    @property
    def string(self) -> str | None:
        """The text that it stands for, None if that is not constant."""
        own = self.resolved
        if own.node.type in ("identifier", "binary_expression", "call_expression") and own.depth <= _MAX_DEPTH:
            return own._made_text()
        if own.node.type == "concatenated_string":
            strings = [own.at(child).string for child in own.node.named_children]
            known = [each for each in strings if each is not None]
            return "".join(known) if len(known) == len(strings) else None
        if own.node.type != "string_literal":
            return None
        parts = []
        for child in own.node.named_children:
            if child.type != "string_content":
                return None
            parts.append(text_of(child))
        return "".join(parts)

    def _made_text(self) -> str | None:
        """The text that a buffer gets from `snprintf`, or that parts are joined to."""
        if self.node.type == "identifier":
            return self._printed()
        if self.node.type == "binary_expression":
            parts = [self.at(child)._as_text() for child in self.node.named_children]
            is_sum = text_of(self.node.children[1]) == "+"
            return f"{parts[0]}{parts[1]}" if is_sum and len(parts) == 2 and None not in parts else None
        name, arguments = called(self.node)
        function = self.node.child_by_field_name("function")
        if (
            name.endswith((".c_str", ".data"))
            and function is not None
            and (text := function.child_by_field_name("argument")) is not None
        ):
            return self.at(text).string
        return self.at(arguments[0])._as_text() if name.rpartition("::")[2] in _TEXTS and len(arguments) == 1 else None

    def _as_text(self) -> str | None:
        number = self.number
        return self.string if number is None else str(number)

    def _printed(self) -> str | None:
        """The text that the last call of `snprintf` before this place in the same function writes to a buffer."""
        calls = self.function.prints.get(self.text, ()) if self.function is not None else ()
        before = bisect_left(calls, self.node.start_byte, key=lambda call: call.start_byte)
        given = calls[before - 1].given if before else ()
        form = self.at(given[0]).string if given else None
        if form is None:
            return None
        values = iter([self.at(each)._as_text() for each in given[1:]])
        parts = [_formatted(part, values) for part in _FORMAT.split(form)]
        return "".join(each for each in parts if each is not None) if None not in parts else None

    @property
    def number(self) -> int | None:
        """The whole number that it stands for, None if that is not constant."""
        own = self.resolved
        node = own.node
        if own.depth > _MAX_DEPTH:
            return None
        if node.type == "identifier":
            bound = own.bindings.get(text_of(node))
            return bound if isinstance(bound, int) else None
        if node.type == "number_literal":
            return literal(text_of(node))
        if node.type in ("true", "false"):
            return int(node.type == "true")
        if node.type == "unary_expression" and (inner := node.child_by_field_name("argument")) is not None:
            value = own.at(inner).number
            return None if value is None else {"-": -value, "+": value, "!": int(not value)}.get(text_of(node.children[0]))
        if (whole := sized_operand(node)) is not None:
            length, width = own.at(whole).length, self.program.widths.get(text_of(whole))
            return length * width if length is not None and width is not None else None
        if node.type in ("binary_expression", "call_expression") and (array := counted_array(node)) is not None:
            return own.at(array).length
        if node.type == "binary_expression":
            return own._operation()
        if node.type == "call_expression":
            return own._converted()
        return None

    def _operation(self) -> int | None:
        left, right = (self.node.child_by_field_name(side) for side in ("left", "right"))
        operator = self.node.child_by_field_name("operator")
        if left is None or right is None or operator is None:
            return None
        first, second = self.at(left).number, self.at(right).number
        if first is None or second is None:
            return None
        result = _calculated(first, text_of(operator), second)
        return result if result is not None and abs(result) < _GREATEST else None

    def _converted(self) -> int | None:
        function, arguments = called(self.node)
        if function not in _FACTORS or len(arguments) != 1:
            return None
        value = self.at(arguments[0]).number
        return None if value is None else value * _FACTORS[function]


#: What a name stands for: an argument, or the value of a counter.
Binding: TypeAlias = Expression | int


def call_site(file: SourceFile, node: Node, bindings: Mapping[str, Binding]) -> int:
    """A number for a call, and for those that lead to it."""
    return hash((str(file.path), node.start_byte, bindings.get(SITE)))


def _allocates(node: Node | None) -> bool:
    return node is not None and (
        node.type == "new_expression"
        or (node.type == "call_expression" and _ALLOCATIONS.fullmatch(called(node)[0]) is not None)
    )


def literal(text: str) -> int | None:
    """The value of a number in C, None if it is not a whole one."""
    digits = text.replace("'", "").lower().rstrip("ulz")
    try:
        number = int(digits, 8) if digits.startswith("0") and digits.isdecimal() else int(digits, 0)
        return number if number < _GREATEST else None
    except ValueError:
        pass
    try:
        real = float(digits.rstrip("f"))
    except ValueError:
        return None
    return int(real) if abs(real) < _GREATEST and real == int(real) else None


def _formatted(part: str, values: Iterator[str | None]) -> str | None:
    """A part of a format, with the next value if it is a conversion."""
    if _FORMAT.fullmatch(part) is None:
        return part
    if part == "%%":
        return "%"
    value, width = next(values, None), part[1:].rstrip("diuslhz")
    if value is None or len(width) > _WIDTH_DIGITS:
        return None
    return value.rjust(int(width or 0), "0" if width.startswith("0") else " ")


def _calculated(first: int, operator: str, second: int) -> int | None:
    match operator:
        case "+":
            return first + second
        case "-":
            return first - second
        case "*":
            return first * second
        case "/" if second:
            return abs(first) // abs(second) * (1 if (first < 0) is (second < 0) else -1)
        case "%" if second > 0 and first >= 0:
            return first % second
        case "==" | "!=" | "<" | "<=" | ">" | ">=":
            return int(_COMPARISONS[operator](first, second))
        case "<<" if 0 <= second < 64:
            return first << second
        case ">>" if 0 <= second < 64:
            return first >> second
    return None
