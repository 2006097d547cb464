"""What sources define: functions, constants, members of classes; the code between them is read by `walk`."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.source.arrays import WIDTHS, declared_sizes, elements_of, members_of
from amalthea_uros.source.constructions import made_class
from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.syntax import called, descendants, is_conditional, is_too_deep, parse, text_of

if TYPE_CHECKING:
    from tree_sitter import Node

_CLASSES = ("class_specifier", "struct_specifier")
_NESTED = ("pointer_declarator", "array_declarator", "reference_declarator", "parenthesized_declarator", "init_declarator")
#: Functions that write a text to a buffer, which they are given first -> the position of its format.
_PRINTS = {"snprintf": 2, "sprintf": 1}
#: Classes that are members of each other.
_MAX_DEPTH = 20
_CHANGES = ("assignment_expression", "update_expression")
#: A macro with parameters whose text is a statement.
_STATEMENT = re.compile(rb"^[ \t]*#[ \t]*define[ \t]+(\w+)\([^)\n]*\)[ \t]*(?:\\\r?\n\s*)?(?:\{|do\b|if\b)", re.MULTILINE)
#: What looks like a call of a function, alone in a line and without a semicolon.
_ALONE = re.compile(rb"^[ \t]*(\w++)[ \t]*\([^\n;{}\\]*\)(?=[ \t\r]*$)", re.MULTILINE)
#: A stack of Zephyr, which is an array by a macro: zephyr include/zephyr/kernel/thread_stack.h.
_STACK = re.compile(r"\bK_(?:THREAD|KERNEL)_STACK_(?:MEMBER|DEFINE)\s*\(\s*(\w+)\s*,")
_STATIC = re.compile(r"\bstatic\b")


class PrintCall(NamedTuple):
    """A call that writes a text to a buffer.

    Attributes
    ----------
    given : the format and the values; empty where they are missing
    """

    start_byte: int
    given: Sequence[Node]


@dataclass(frozen=True, eq=False)
class CodeFunction:
    """A function, a method or a lambda.

    Attributes
    ----------
    owner : the class of a method, "" for other functions
    parameters : their names, in order; "" for one without
    locals : names that are declared in it, parameters included
    is_macro : whether it is a macro with parameters, whose text is read as that of a function
    """

    name: str
    file: SourceFile
    body: Node
    owner: str = ""
    parameters: tuple[str, ...] = ()
    locals: frozenset[str] = frozenset()
    is_macro: bool = False

    @property
    def scope(self) -> str:
        """A name for what is declared in it."""
        return f"{self.file.path}:{self.body.start_byte}:"

    @cached_property
    def prints(self) -> Mapping[str, Sequence[PrintCall]]:
        """The calls that write to a buffer, in order, by the text of the buffer."""
        found: dict[str, list[PrintCall]] = defaultdict(list)
        for node in descendants(self.body):
            name, arguments = called(node) if node.type == "call_expression" else ("", [])
            format_place = _PRINTS.get(name.rpartition("::")[2])
            if format_place is not None and arguments:
                found[text_of(arguments[0])].append(PrintCall(node.start_byte, arguments[format_place:]))
        return found

    @cached_property
    def returned(self) -> Node | None:
        """The expression that it returns, if it does nothing else, or if that is the address of a variable that stays."""
        if self.name == self.owner:
            return None
        statements = [child for child in self.body.named_children if child.type != "comment"]
        returns = [each for each in descendants(self.body) if each.type == "return_statement"]
        if len(returns) != 1 or statements[-1:] != returns or not returns[0].named_children:
            return None
        given = text_of(returns[0].named_children[0])
        name = given.removeprefix("&").strip()
        stays = any(_is_static(name, statement) for statement in text_of(self.body).split(";"))
        if len(statements) > 1 and not stays and (not given.startswith("&") or name in self.locals):
            return None
        return returns[0].named_children[0]


@dataclass(eq=False)
class FunctionMacro:
    """A macro with parameters."""

    name: str
    file: SourceFile
    node: Node

    @cached_property
    def function(self) -> CodeFunction | None:
        """It as if it were a function; None if its text is no statement."""
        value, parameters = self.node.child_by_field_name("value"), self.node.child_by_field_name("parameters")
        text = text_of(value) if value is not None else ""
        if value is None or parameters is None or "##" in text:
            return None
        # Its code has the rows that it has in the file.
        code = f"{chr(10) * value.start_point.row}void f{text_of(parameters)} {{ {text.replace(chr(92), chr(32))}; }}"
        root = parse(SourceFile(self.file.path, code.encode()))
        body = next((each for each in descendants(root) if each.type == "compound_statement"), None)
        if body is None or body.has_error:
            return None
        names = tuple(text_of(each) for each in parameters.named_children)
        return CodeFunction(self.name, self.file, body, parameters=names, locals=frozenset(names), is_macro=True)


@dataclass(slots=True, eq=False)
class CodeProgram:
    """Everything that sources define.

    Attributes
    ----------
    macros : texts of macros without parameters, and of enumerators without a value; with several ones the value is unknown
    function_macros : those with parameters
    functions : by name; several of one name in different files or classes
    members : of classes, in their order
    objects : of each class, the places where one of it comes into being, and the class whose member it is, "" for none; an array
        has two
    classes : of variables and members that are objects, or lead to one; "" where several have this name
    arrays : expressions of their lengths, by name; "" if that follows from the list that they are initialised with
    widths : of the elements of arrays in bytes, by the name of the array, as far as their type shows it
    assigned : what is assigned to members, by their texts, such as `quality.reliability`
    constructed : of a class with one constructor, what that gives its members
    constructors : of each class
    statics : names that are known in one file only, with its path
    values : what variables are initialised with, by their keys
    findings : files that are not read
    changed : names that something assigns to, or whose address is taken: what they are initialised with may not be their value
    """

    files: list[tuple[SourceFile, Node]] = field(default_factory=list)
    macros: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    function_macros: dict[str, FunctionMacro] = field(default_factory=dict)
    functions: dict[str, list[CodeFunction]] = field(default_factory=lambda: defaultdict(list))
    members: dict[str, dict[str, None]] = field(default_factory=lambda: defaultdict(dict))
    objects: dict[str, dict[str, str]] = field(default_factory=lambda: defaultdict(dict))
    classes: dict[str, str] = field(default_factory=dict)
    arrays: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    widths: dict[str, int] = field(default_factory=dict)
    assigned: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    constructed: dict[str, dict[str, Node]] = field(default_factory=lambda: defaultdict(dict))
    constructors: dict[str, list[CodeFunction]] = field(default_factory=lambda: defaultdict(list))
    statics: set[tuple[str, str]] = field(default_factory=set)
    values: dict[str, tuple[Node, CodeFunction | SourceFile]] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    changed: set[str] = field(default_factory=set)
    _object_numbers: dict[str, int] = field(default_factory=dict)
    _elements: dict[Node, Sequence[Node]] = field(default_factory=dict)
    _given_members: dict[tuple[Node, str], Mapping[str, Node]] = field(default_factory=dict)

    def elements_of(self, values: Node) -> Sequence[Node]:
        """The elements of a list, found once, because thousands of expressions may be elements of it."""
        if values not in self._elements:
            self._elements[values] = elements_of(values)
        return self._elements[values]

    def member_of(self, values: Node, member: str, owner: str) -> Node | None:
        """The value that a list gives a member of a structure, by its name or by its position; None if it gives it none."""
        if (values, owner) not in self._given_members:
            self._given_members[values, owner] = members_of(values, tuple(self.members.get(owner, ())))
        return self._given_members[values, owner].get(member)

    def number_of_objects(self, owner: str) -> int:
        """How many objects of a class there are, as members, too; 0 if nothing shows one; asked for when everything is read."""
        return self._number_of_objects(owner, 0)

    def _number_of_objects(self, owner: str, depth: int) -> int:
        known = self._object_numbers
        if owner in known or depth > _MAX_DEPTH:
            return known.get(owner, 0)
        known[owner] = 0  # of a class in itself, which only looks so where a brace is missing
        known[owner] = sum(
            max(1, self._number_of_objects(around, depth + 1)) if around else 1
            for around in self.objects.get(owner, {}).values()
        )
        return known[owner]

    def every_function(self) -> Iterator[CodeFunction]:
        """All functions."""
        for group in self.functions.values():
            yield from group


def read_program(files: tuple[SourceFile, ...]) -> CodeProgram:
    """What files define.

    Raises
    ------
    ReadError : the parsers are not installed.
    """
    program = CodeProgram()
    for file in _with_semicolons(files):
        root = parse(file)
        if is_too_deep(root):
            program.findings.append(_too_deep(file))
            continue
        for name, size in _stacks(file.text.decode("utf-8", "replace")):
            program.arrays[name].add(size)
        program.files.append((file, root))
        for node in descendants(root):
            _note(program, file, node)
    for name, macro in program.function_macros.items():
        function = macro.function if "rclc_" in text_of(macro.node) else None
        if function is not None:
            program.functions[name].append(function)
    return program


def _stacks(text: str) -> Iterator[tuple[str, str]]:
    """The names of stacks of Zephyr, and their sizes."""
    for statement in text.split(";")[:-1]:
        begin, end = _STACK.search(statement), statement.rstrip()
        if begin is not None and end.endswith(")") and (size := end[begin.end() : -1].strip()):
            yield begin[1], size


def _with_semicolons(files: tuple[SourceFile, ...]) -> list[SourceFile]:
    """Files with a semicolon where a macro that is a statement has none, which compiles, but is no statement for the parser."""
    names = {name for file in files for name in _STATEMENT.findall(file.text)}
    if not names:
        return list(files)

    def with_semicolon(found: re.Match[bytes]) -> bytes:
        return found[0] + b";" if found[1] in names else found[0]

    return [SourceFile(file.path, _ALONE.sub(with_semicolon, file.text)) for file in files]


def _too_deep(file: SourceFile) -> Finding:
    advice = "Give only the files of the application."
    return Finding("IMP002", Severity.ERROR, "the code is nested too deeply; the file is not read", Location(file.path), advice)


def _is_static(name: str, statement: str) -> bool:
    """Whether a statement seems to declare a variable that stays."""
    static = _STATIC.search(statement)
    return static is not None and re.search(rf"\b{re.escape(name)}\b", statement[static.end() :]) is not None


def _note(program: CodeProgram, file: SourceFile, node: Node) -> None:
    if node.type in ("declaration", "field_declaration"):
        _note_objects(program, file, node)
        kind = node.child_by_field_name("type")
        for array, size in declared_sizes(node).items():
            program.arrays[array].add(size)
            if kind is not None and text_of(kind) in WIDTHS:
                program.widths[array] = WIDTHS[text_of(kind)]
    match node.type:
        case "new_expression" | "template_function":
            _note_made(program, file, node)
        case "preproc_def":
            name, value = node.child_by_field_name("name"), node.child_by_field_name("value")
            if name is not None:
                program.macros[text_of(name)].add(text_of(value).strip() if value is not None else "")
        case "preproc_function_def":
            if (name := node.child_by_field_name("name")) is not None:
                program.function_macros[text_of(name)] = FunctionMacro(text_of(name), file, node)
        case "function_definition":
            _note_function(program, file, node)
        case "declaration":
            if _enclosing(node, ("function_definition", "lambda_expression")) is None:
                _note_variables(program, file, node)
        case "field_declaration":
            _note_members(program, file, node)
        case "enumerator":
            name, value = node.child_by_field_name("name"), node.child_by_field_name("value")
            if name is not None and value is not None:
                program.values[text_of(name)] = value, file
        case "enumerator_list":
            _note_counted(program, node)
        case "assignment_expression" | "update_expression":
            _note_change(program, node)


def _note_counted(program: CodeProgram, enumerators: Node) -> None:
    """The values of enumerators without one, as expressions: one more than that of the enumerator before, 0 for the first."""
    before: str | None = ""
    number = 0
    for node in enumerators.named_children:
        name, value = node.child_by_field_name("name"), node.child_by_field_name("value")
        if is_conditional(node):
            before = None  # of those that follow
        if node.type != "enumerator" or name is None:
            continue
        if value is not None:
            before, number = f"({text_of(value)}) + ", 0
        elif before is not None:
            program.macros[text_of(name)].add(f"{before}{number}")
        number += 1


def _note_function(program: CodeProgram, file: SourceFile, node: Node) -> None:
    declarator, body = node.child_by_field_name("declarator"), node.child_by_field_name("body")
    while declarator is not None and declarator.type != "function_declarator":
        # A function that returns a reference has no field for what is around its declarator.
        declarator = declarator.child_by_field_name("declarator") or next(iter(declarator.named_children), None)
    named = declarator.child_by_field_name("declarator") if declarator is not None else None
    if declarator is None or named is None or body is None:
        return
    qualified = text_of(named).split("::")
    owner = qualified[-2] if len(qualified) > 1 else _class_around(node)
    function = function_of(qualified[-1].strip(), file, declarator, body, owner)
    program.functions[function.name].append(function)
    if function.name == owner:
        program.constructors[owner].append(function)
        program.constructed[owner] |= _given_to_members(node, body)
    for statement in descendants(body):
        if statement.type == "declaration":
            for name, value in declared(statement):
                if value is not None:
                    program.values[function.scope + text_of(name)] = value, function


def _note_members(program: CodeProgram, file: SourceFile, node: Node) -> None:
    owner, value = _class_around(node), node.child_by_field_name("default_value")
    names = [text_of(name) for name, _ in declared(node)]
    program.members[owner] |= dict.fromkeys(names)
    if value is not None and len(names) == 1:
        program.values[f"{owner}::{names[0]}"] = value, file


def _given_to_members(constructor: Node, body: Node) -> dict[str, Node]:
    """The values that a constructor gives members of its class, in the list before its body, or by statements of it."""
    given = {}
    for part in constructor.named_children:
        for each in part.named_children if part.type == "field_initializer_list" else ():
            if each.named_child_count == 2:
                given[text_of(each.named_children[0])] = each.named_children[1]
    for statement in body.named_children:
        assignment = next(iter(statement.named_children), None)
        if statement.type == "expression_statement" and assignment is not None and assignment.type == "assignment_expression":
            left, right = assignment.child_by_field_name("left"), assignment.child_by_field_name("right")
            if left is not None and right is not None:
                given[text_of(left).removeprefix("this->")] = right
    return given


def function_of(name: str, file: SourceFile, declarator: Node | None, body: Node, owner: str) -> CodeFunction:
    """A function with a declarator, which has its parameters, and a body."""
    listed = declarator.child_by_field_name("parameters") if declarator is not None else None
    parameters = tuple(
        next((text_of(name) for name, _ in declared(each)), "")
        for each in (listed.named_children if listed is not None else ())
        if each.type in ("parameter_declaration", "optional_parameter_declaration")
    )
    inner = {text_of(name) for each in descendants(body) if each.type == "declaration" for name, _ in declared(each)}
    return CodeFunction(name, file, body, owner, parameters, frozenset({*inner, *parameters}))


def _note_objects(program: CodeProgram, file: SourceFile, node: Node) -> None:
    kind = node.child_by_field_name("type")
    if kind is None or kind.type not in ("type_identifier", "qualified_identifier", "template_type", *_CLASSES):
        return
    named = kind.child_by_field_name("name")
    if named is None and kind.type in _CLASSES:
        named = next((variable for variable, _ in declared(node)), None)
    name = text_of(named or kind).rpartition("::")[2]
    for variable, _ in declared(node):
        known = program.classes.setdefault(text_of(variable), name)
        program.classes[text_of(variable)] = name if known == name else ""
    around = _class_around(node) if node.type == "field_declaration" else ""
    for declarator in node.children_by_field_name("declarator"):
        types = {each.type for each in descendants(declarator)}
        if not types & {"pointer_declarator", "reference_declarator", "function_declarator"}:
            place = f"{file.path}:{declarator.start_byte}"
            program.objects[name] |= {place: around} | ({f"{place}[]": around} if "array_declarator" in types else {})


def _note_made(program: CodeProgram, file: SourceFile, node: Node) -> None:
    """Objects that are made while the program runs."""
    if made := made_class(node):
        program.objects[made][f"{file.path}:{node.start_byte}"] = _class_around(node)


def _note_variables(program: CodeProgram, file: SourceFile, node: Node) -> None:
    is_static = any(child.type == "storage_class_specifier" and text_of(child) == "static" for child in node.children)
    for name, value in declared(node):
        key = text_of(name)
        if is_static:
            program.statics.add((str(file.path), key))
            key = f"{file.path}:{key}"
        if value is not None:
            program.values[key] = value, file


def _note_change(program: CodeProgram, node: Node) -> None:
    target = node.child_by_field_name("left") or node.child_by_field_name("argument")
    value = node.child_by_field_name("right")
    if target is not None and target.type == "field_expression" and value is not None:
        program.assigned[text_of(target)].add(text_of(value))
    if target is not None and not _is_in_constructor(node):
        program.changed.add(text_of(target).rpartition(".")[2].rpartition(">")[2])


def _is_in_constructor(node: Node) -> bool:
    around = _enclosing(node, ("function_definition",))
    return around is not None and around.child_by_field_name("type") is None and bool(_class_around(around))


def declared(node: Node) -> Iterator[tuple[Node, Node | None]]:
    """The variables that a declaration declares, with what they are initialised with."""
    for declarator in node.children_by_field_name("declarator"):
        value = declarator.child_by_field_name("value")
        inner: Node | None = declarator
        while inner is not None and inner.type in _NESTED:
            inner = inner.child_by_field_name("declarator") or next(iter(inner.named_children), None)
        if inner is not None and inner.type in ("identifier", "field_identifier"):
            yield inner, value


def _class_around(node: Node) -> str:
    around = _enclosing(node, _CLASSES)
    name = around.child_by_field_name("name") if around is not None else None
    parent = around.parent if name is None and around is not None else None
    if parent is not None and parent.type == "type_definition":
        name = parent.child_by_field_name("declarator")
    elif parent is not None:
        # One without a name is called as its first object.
        name = next((variable for variable, _ in declared(parent)), None)
    return text_of(name) if name is not None else ""


def _enclosing(node: Node, types: tuple[str, ...]) -> Node | None:
    parent = node.parent
    while parent is not None and parent.type not in types:
        parent = parent.parent
    return parent
