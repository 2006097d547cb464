"""The calls in sources in the order in which they are made, from each function that no other one calls."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.limits import SOURCE_NODES
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.source.callees import Callees
from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.intervals import interval_of, interval_of_macro
from amalthea_uros.source.program import CodeFunction, CodeProgram, declared, function_of
from amalthea_uros.source.scope import SITE, THIS, Binding, Expression, call_site
from amalthea_uros.source.spans import TextSpans
from amalthea_uros.source.syntax import branches, called, descendants, is_conditional, location_of, parse_expression, text_of
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from tree_sitter import Node

#: The place of a loop or choice: its file and its first byte.
Mark: TypeAlias = tuple[str, int]

#: A choice, and the branch of it that something is in.
Branch: TypeAlias = tuple[Mark, Mark]

#: Nested nodes, those of called functions included.
_MAX_DEPTH = 350
#: Iterations of a loop that are followed one by one, because they create something each.
_MAX_ITERATIONS = 64
#: What a loop is called that waits busily for a time, and the functions that read a clock.
BUSY_LOOP = "while"
CLOCKS = frozenset(
    [
        *("millis", "micros", "HAL_GetTick", "xTaskGetTickCount", "osKernelGetTickCount", "k_uptime_get", "k_uptime_get_32"),
        *("esp_timer_get_time", "time_us_64", "time_us_32", "get_absolute_time", "uxr_millis", "rmw_uros_epoch_millis"),
    ]
)
#: The branch of a choice that what follows a branch that leaves the block is in.
_AFTER: Mark = ("", 0)
_LITERALS = ("true", "false", "number_literal")
_LOOPS = ("while_statement", "do_statement", "for_statement", "for_range_loop")
_CHOICES = ("if_statement", "switch_statement", "conditional_expression")
#: Calls of functions of the sources that are followed; those of functions that call others twice grow without limit.
_MAX_ENTRIES = 5_000
#: How the entry of a program can be called; methods can have the same names.
ENTRIES = ("main", "app_main", "appMain", "setup", "loop")
#: Functions of the application are followed if they lead to calls whose names begin so, or are among these.
_RELEVANT = ("rclc_", "rcl_", "rmw_", "set_microros_")


@dataclass(frozen=True, slots=True, eq=False)
class FunctionCall:
    """A call of a function that the sources do not define.

    Attributes
    ----------
    name : of the function
    arguments : as they are written
    place : where it is
    root : the function at whose start the path begins that leads here; None for code outside of functions
    function : the function that it is in
    loops : the loops around it, the outermost first, those around the calls that lead here included
    conditions : the branches of choices that it is in
    uncertain : whether it is compiled only under a condition that the sources do not decide
    unchecked : whether its result is not used
    every : the least time between two such calls that a clock keeps, 0 for none
    """

    name: str
    arguments: tuple[Expression, ...]
    place: Location
    root: CodeFunction | None
    function: CodeFunction | None
    loops: tuple[Mark, ...]
    conditions: tuple[Branch, ...]
    uncertain: bool
    unchecked: bool
    every: Time

    def excludes(self, other: FunctionCall) -> bool:
        """Whether it is in another branch of a choice than another call, such as another state of a state machine."""
        branches = dict(self.conditions)
        return any(branches.get(choice, branch) != branch for choice, branch in other.conditions)

    def always_with(self, other: FunctionCall) -> bool:
        """Whether it is made whenever the code of another call is reached, unless that is left early."""
        return {each for each in self.conditions if each[1] != _AFTER} <= set(other.conditions)

    def argument(self, index: int) -> Expression | None:
        """An argument, None if there are fewer."""
        return self.arguments[index] if -len(self.arguments) <= index < len(self.arguments) else None


@dataclass(frozen=True, slots=True)
class _WalkPosition:
    file: SourceFile
    function: CodeFunction | None
    bindings: Mapping[str, Binding]
    stack: tuple[CodeFunction, ...] = ()
    loops: tuple[Mark, ...] = ()
    conditions: tuple[Branch, ...] = ()
    uncertain: bool = False
    every: Time = 0
    depth: int = 0


class CodeWalk:
    """Walks through the functions of a program.

    Attributes
    ----------
    calls : in order, those of each root together
    seen : places of all calls that were visited
    findings : code that is nested too deeply, or too much
    """

    def __init__(self, program: CodeProgram, names: frozenset[str], threads: Mapping[str, tuple[int, int]]) -> None:
        """Begin.

        Parameters
        ----------
        names : of functions that matter, besides those of micro-ROS
        threads : of functions that start threads, the positions of their entry and of what that is given
        """
        self.program = program
        self._threads = threads
        self._given: dict[str, Expression] = {}
        self.calls: list[FunctionCall] = []
        self._calls_by_root: dict[CodeFunction | None, list[FunctionCall]] = defaultdict(list)
        self.seen: set[tuple[str, int]] = set()
        self.inactive: dict[str, set[tuple[int, int]]] = defaultdict(set)
        self.lambdas: dict[str, CodeFunction] = {}
        self.findings: list[Finding] = []
        self._left = SOURCE_NODES
        self._entries = _MAX_ENTRIES
        self._names = names
        self._started: list[CodeFunction] = []
        self._relevant = relevant_functions(program, names)
        self._callees = Callees(program.every_function())
        self._followed = set(self._relevant.functions)

    def all(self) -> None:
        """Walk from code outside of functions, then from each function that no other one calls."""
        for file, root in self.program.files:
            self._children(root, _WalkPosition(file, None, {}))
        inactive = {path: TextSpans(spans) for path, spans in self.inactive.items()}
        for group in self.program.functions.values():
            group[:] = [each for each in group if each.body.start_byte not in inactive.get(str(each.file.path), ())]
        self._callees = Callees(self.program.every_function())
        entries = dict.fromkeys(self._thread_entries())
        for function in self.program.every_function():
            is_entry = not function.owner and function.name in ENTRIES
            is_root = is_entry or (function.name not in self._relevant.called and not function.is_macro)
            if is_root and function in self._relevant.functions and function.name not in entries:
                self.function(function)
        for name in entries:
            for function in self.program.functions.get(name, ()):
                if function in self._relevant.functions:
                    self.function(function)
        # Lambdas that are the code of threads; what they call is called by others only there.
        while self._started:
            self.function(self._started.pop(0))

    def function(self, function: CodeFunction) -> None:
        """Walk through a function; the code of a thread has what it is given."""
        given = self._given.get(function.name)
        bindings: dict[str, Binding] = {function.parameters[0]: given} if given is not None and function.parameters else {}
        self._visit(function.body, _WalkPosition(function.file, function, bindings, (function,)))

    def _thread_entries(self) -> Iterator[str]:
        for _, root in self.program.files:
            for node in descendants(root):
                name, arguments = called(node) if node.type == "call_expression" else ("", [])
                if name in self._threads and self._threads[name][0] < len(arguments):
                    yield text_of(arguments[self._threads[name][0]]).lstrip("&")

    def calls_from(self, function: CodeFunction) -> list[FunctionCall]:
        """The calls on the paths that begin with a function."""
        found = self._calls_by_root[function]
        if found or function not in self._followed:
            return found
        before = len(self.calls)
        self.function(function)
        # They were found already on the paths of the callers.
        del self.calls[before:]
        return found

    def _children(self, node: Node, context: _WalkPosition) -> None:
        for child in node.named_children:
            self._visit(child, context)

    def _visit(self, node: Node, context: _WalkPosition) -> None:
        self._left -= 1
        if self._left < 0 or context.depth > _MAX_DEPTH:
            self._stop(node, context)
            return
        context = replace(context, depth=context.depth + 1)
        if is_conditional(node):
            self._conditional(node, context)
        elif node.type == "call_expression":
            self._call(node, context)
        elif node.type in _LOOPS:
            self._loop(node, context)
        elif node.type in _CHOICES:
            self._choice(node, context)
        elif node.type in ("compound_statement", "case_statement"):
            self._block(node, context)
        elif node.type == "lambda_expression":
            self._lambda(node, context)
        elif node.type == "function_definition" or (node.type == "field_declaration_list" and context.function is not None):
            return
        else:
            self._children(node, context)

    def _block(self, node: Node, context: _WalkPosition) -> None:
        """The statements of a block; those after a branch that leaves it are not made with that branch."""
        for child in node.named_children:
            self._visit(child, context)
            branch = child.child_by_field_name("consequence") if child.type == "if_statement" else None
            if branch is not None and child.child_by_field_name("alternative") is None and _leaves(branch):
                context = replace(context, conditions=(*context.conditions, (_mark(child, context), _AFTER)))

    def _stop(self, node: Node, context: _WalkPosition) -> None:
        reason = "there is too much code" if min(self._left, self._entries) < 0 else "the code is nested too deeply"
        if not any(finding.message.startswith(reason) for finding in self.findings):
            place = location_of(context.file, node)
            message = f"{reason}; the rest is not read"
            self.findings.append(Finding("IMP003", Severity.WARNING, message, place, "Give only the files of the application."))

    def _conditional(self, node: Node, context: _WalkPosition) -> None:
        def value(condition: Node) -> int | None:
            return Expression(self.program, condition, context.file).number

        taken = set()
        for child, unknown in branches(node, self.program.macros, value):
            taken.add(child.id)
            self._visit(child, replace(context, uncertain=context.uncertain or unknown))
        self._note_inactive(node, taken, context.file)

    def _note_inactive(self, node: Node, taken: set[int], file: SourceFile) -> None:
        current: Node | None = node
        while current is not None:
            for child in current.named_children:
                if child.id not in taken and child.type not in ("preproc_elif", "preproc_elifdef", "preproc_else"):
                    self.inactive[str(file.path)].add((child.start_byte, child.end_byte))
            current = current.child_by_field_name("alternative")

    def _loop(self, node: Node, context: _WalkPosition) -> None:
        header = [node.child_by_field_name(name) for name in ("initializer", "condition", "update", "right")]
        for part in header:
            if part is not None:
                self._visit(part, context)
        body = node.child_by_field_name("body")
        if body is None:
            return
        condition = node.child_by_field_name("condition")
        if condition is not None and node.type != "for_statement" and self._is_timed(condition, body):
            self._add(BUSY_LOOP, (), node, context)
        if node.type == "do_statement" and condition is not None and self._expression(condition, context).number == 0:
            # The usual form of a macro, or of a block that `break` leaves.
            self._visit(body, context)
            return
        counted = self._elements(node, context) if node.type == "for_range_loop" else self._iterations(node, context)
        if counted is not None:
            name, values = counted
            for value in values:
                self._visit(body, replace(context, bindings={**context.bindings, name: value}))
        else:
            loops = (*context.loops, _mark(node, context))
            self._visit(body, replace(context, loops=loops, bindings={**context.bindings, **self._element(node, context)}))

    def _element(self, node: Node, context: _WalkPosition) -> dict[str, Binding]:
        """The variable of a loop over something whose length is unknown, as any element of it."""
        name, array = _variable(node), node.child_by_field_name("right")
        element = parse_expression(f"{text_of(array)}[{name}]", is_c=False) if name and array is not None else None
        return {} if element is None else {name: self._expression(element, context)}

    def _is_timed(self, condition: Node, body: Node) -> bool:
        """Whether a loop does nothing that matters until a clock shows a time."""
        inner = set(_called_names(body))
        return not inner & self._relevant.called_with_effect and any(name in CLOCKS for name in _called_names(condition))

    def _elements(self, node: Node, context: _WalkPosition) -> tuple[str, Sequence[Binding]] | None:
        """The variable of a loop over an array, and the elements."""
        name, array = _variable(node), node.child_by_field_name("right")
        if not name or array is None:
            return None
        length = self._expression(array, context).length
        if length is None or length > _MAX_ITERATIONS:
            return None
        elements = [parse_expression(f"{text_of(array)}[{index}]", is_c=False) for index in range(length)]
        return name, [self._expression(each, context) for each in elements if each is not None]

    def _iterations(self, node: Node, context: _WalkPosition) -> tuple[str, Sequence[Binding]] | None:
        """The counter of a loop that counts up from one constant to another, and its values."""
        start, condition, update = (node.child_by_field_name(name) for name in ("initializer", "condition", "update"))
        if start is None or condition is None or update is None or condition.type != "binary_expression":
            return None
        name, first = _start(start)
        left, right = condition.child_by_field_name("left"), condition.child_by_field_name("right")
        operator = condition.child_by_field_name("operator")
        if not name or first is None or left is None or right is None or operator is None or text_of(left) != name:
            return None
        if "".join(text_of(update).split()) not in (f"{name}++", f"++{name}", f"{name}+=1"):
            return None
        low, high = self._expression(first, context).number, self._expression(right, context).number
        if low is None or high is None or text_of(operator) not in ("<", "<=", "!="):
            return None
        end = high + (text_of(operator) == "<=")
        return (name, range(low, end)) if end - low <= _MAX_ITERATIONS else None

    def _choice(self, node: Node, context: _WalkPosition) -> None:
        condition = node.child_by_field_name("condition")
        if condition is not None:
            self._visit(condition, context)
        if (
            condition is not None
            and node.type != "switch_statement"
            and (decided := self._decided(condition, context)) is not None
        ):
            taken = node.child_by_field_name("consequence" if decided else "alternative")
            if taken is not None:
                self._visit(taken, context)
            return
        body = node.child_by_field_name("body") if node.type == "switch_statement" else None
        for child in (body or node).named_children:
            if condition is None or child.id != condition.id:
                branch = _mark(node, context), _mark(child, context)
                every = max(context.every, self._interval(node, child, context))
                self._visit(child, replace(context, conditions=(*context.conditions, branch), every=every))

    def _interval(self, choice: Node, branch: Node, context: _WalkPosition) -> Time:
        """The least time between two executions of a branch that its condition keeps."""
        condition, taken = choice.child_by_field_name("condition"), choice.child_by_field_name("consequence")
        if choice.type != "if_statement" or condition is None or taken is None or taken.id != branch.id:
            return 0
        return interval_of(condition, branch, lambda node: self._expression(node, context).number)

    def _interval_of_argument(self, name: str, arguments: Sequence[Node], argument: Node, context: _WalkPosition) -> Time:
        """The least time between two executions of an argument of a macro that executes it every so often."""
        named = self.program.function_macros.get(name)
        macro = None if named is None else named.function
        if macro is None or len(macro.parameters) != len(arguments):
            return 0
        given = dict(zip(macro.parameters, arguments, strict=True))
        parameter = next((name for name, each in given.items() if each.id == argument.id), "")
        return interval_of_macro(
            macro, parameter, lambda node: self._expression(given.get(text_of(node), node), context).number
        )

    def _decided(self, condition: Node, context: _WalkPosition) -> bool | None:
        """Whether a condition holds that only depends on constants, counters and what parameters are given; None if unknown."""
        condition = condition.child_by_field_name("value") or condition
        for each in descendants(condition):
            if each.type in ("identifier", "field_expression", "subscript_expression", "pointer_expression"):
                bound = context.bindings.get(text_of(each))
                is_value = isinstance(bound, int) or (bound is not None and bound.node.type in _LITERALS)
                if each.type != "identifier" or not (is_value or self.program.macros.get(text_of(each))):
                    return None
        number = self._expression(condition, context).number
        return None if number is None else bool(number)

    def _lambda(self, node: Node, context: _WalkPosition) -> None:
        """Code that is called later; what creates a callback of it finds it by its place."""
        body = node.child_by_field_name("body")
        if body is not None:
            name = f"lambda_in_line_{node.start_point.row + 1}"
            owner = context.function.owner if context.function is not None else ""
            declarator = node.child_by_field_name("declarator")
            function = function_of(name, context.file, declarator, body, owner)
            self.lambdas[text_of(node)] = function
            self._followed.add(function)

    def _expression(self, node: Node, context: _WalkPosition) -> Expression:
        return Expression(self.program, node, context.file, context.function, context.bindings)

    def _call(self, node: Node, context: _WalkPosition) -> None:
        self.seen.add((str(context.file.path), node.start_byte))
        name, arguments = called(node)
        written = [each for each in arguments if text_of(each) != ";"]
        for argument in arguments:
            every = max(context.every, self._interval_of_argument(name, written, argument, context))
            self._visit(argument, replace(context, every=every) if every > context.every else context)
        callee = self._callee(name, len(arguments), node, context)
        expressions = tuple(self._expression(argument, context) for argument in arguments)
        if callee is not None:
            if callee not in context.stack and callee in self._relevant.functions:
                holder = self._holder(node, callee, context)
                self._enter(callee, expressions, holder, call_site(context.file, node, context.bindings), context)
            return
        if name in self._threads and self._threads[name][1] < len(expressions):
            entry, given = self._threads[name]
            self._given.setdefault(expressions[entry].name, expressions[given])
        if name in self._names:
            self._started += [self.lambdas[text] for given in arguments if (text := text_of(given)) in self.lambdas]
        self._add(name.removeprefix("::").removeprefix("std::").rpartition("this->")[2], expressions, node, context)

    def _add(self, name: str, arguments: tuple[Expression, ...], node: Node, context: _WalkPosition) -> None:
        root = context.stack[0] if context.stack else None
        call = FunctionCall(
            name,
            arguments,
            location_of(context.file, node),
            root,
            context.function,
            context.loops,
            context.conditions,
            context.uncertain,
            _is_unused(node),
            context.every,
        )
        self.calls.append(call)
        self._calls_by_root[root].append(call)

    def _callee(self, name: str, number: int, node: Node, context: _WalkPosition) -> CodeFunction | None:
        """The function of the sources that is called: of the object's class, else the same class or file, else the only one.

        Parameters
        ----------
        number : of arguments, which distinguishes overloads
        """
        function = node.child_by_field_name("function")
        given = function.child_by_field_name("argument") if function is not None else None
        called_class = (
            self._expression(given, context).owner if given is not None else name.rpartition("::")[0].rpartition("::")[2]
        )
        short = name.rpartition("::")[2].rpartition(".")[2].rpartition(">")[2]
        own_class = context.function.owner if context.function is not None and given is None else ""
        return self._callees.of(short, number, (called_class, own_class), context.file)

    def _holder(self, node: Node, callee: CodeFunction, context: _WalkPosition) -> Binding | None:
        """The object whose method a call calls; within a method of the same class, that of the method."""
        function = node.child_by_field_name("function")
        given = (
            function.child_by_field_name("argument") if function is not None and function.type == "field_expression" else None
        )
        if given is not None and given.type != "this":
            return self._expression(given, context)
        is_same = context.function is not None and bool(callee.owner) and callee.owner == context.function.owner
        return context.bindings.get(THIS) if is_same else None

    def _enter(
        self,
        callee: CodeFunction,
        arguments: tuple[Expression, ...],
        holder: Binding | None,
        site: int,
        context: _WalkPosition,
    ) -> None:
        self._entries -= 1
        if self._entries < 0:
            self._stop(callee.body, context)
            return
        bindings: dict[str, Binding] = dict(zip(callee.parameters, arguments, strict=False))
        bindings.pop("", None)
        bindings[SITE] = site
        if holder is not None:
            bindings[THIS] = holder
        inner = replace(context, file=callee.file, function=callee, bindings=bindings, stack=(*context.stack, callee))
        self._visit(callee.body, inner)


@dataclass(frozen=True, slots=True)
class Relevance:
    """Which functions matter.

    Attributes
    ----------
    functions : those that lead to calls that matter
    called : names of functions that others call
    called_with_effect : names of functions that matter, and of those that lead to them
    """

    functions: frozenset[CodeFunction]
    called: frozenset[str]
    called_with_effect: frozenset[str]


def relevant_functions(program: CodeProgram, names: frozenset[str]) -> Relevance:
    """The functions that lead to calls of micro-ROS, of delays and of the operating system."""
    calls = {function: frozenset(_called_names(function.body)) for function in program.every_function()}
    callers: dict[str, set[CodeFunction]] = {}
    for function, inner in calls.items():
        for name in inner:
            if any(each is not function for each in program.functions.get(name, ())):
                callers.setdefault(name, set()).add(function)
    found = {function for function, inner in calls.items() if any(n.startswith(_RELEVANT) or n in names for n in inner)}
    waiting = list(found)
    while waiting:
        for caller in callers.get(waiting.pop().name, ()):
            if caller not in found:
                found.add(caller)
                waiting.append(caller)
    every = {name for inner in calls.values() for name in inner}
    effects = {name for name in every if name.startswith(_RELEVANT) or name in names} | {each.name for each in found}
    return Relevance(frozenset(found), frozenset(callers), frozenset(effects))


def _called_names(body: Node) -> Iterator[str]:
    for node in descendants(body):
        if node.type == "call_expression":
            yield called(node)[0].rpartition("::")[2].rpartition(".")[2].rpartition(">")[2]


def _leaves(branch: Node) -> bool:
    """Whether a branch ends with a statement that leaves the block around it."""
    last = branch.named_children[-1] if branch.type == "compound_statement" and branch.named_children else branch
    return last.type in ("return_statement", "break_statement", "continue_statement")


def _mark(node: Node, context: _WalkPosition) -> Mark:
    return str(context.file.path), node.start_byte


def _variable(node: Node) -> str:
    """The variable of a loop over elements, "" for other loops."""
    declarator = node.child_by_field_name("declarator")
    while declarator is not None and declarator.type != "identifier":
        declarator = next(iter(declarator.named_children), None)
    return text_of(declarator) if declarator is not None else ""


def _start(node: Node) -> tuple[str, Node | None]:
    """The counter that a loop begins with, and its first value."""
    if node.type == "declaration":
        return next(((text_of(name), value) for name, value in declared(node)), ("", None))
    if node.type == "assignment_expression" and (left := node.child_by_field_name("left")) is not None:
        return text_of(left), node.child_by_field_name("right")
    return "", None


def _is_unused(node: Node) -> bool:
    """Whether the result of a call is a statement of its own, or cast to nothing."""
    parent = node.parent
    while parent is not None and parent.type in ("parenthesized_expression", "cast_expression"):
        parent = parent.parent
    return parent is not None and parent.type == "expression_statement"
