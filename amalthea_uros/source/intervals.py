"""Conditions under which something is done only every so often: a clock shows that some time has passed since it was done last."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from amalthea_uros.source.syntax import descendants, text_of
from amalthea_uros.units import MICROSECOND, MILLISECOND, Time

if TYPE_CHECKING:
    from tree_sitter import Node

    from amalthea_uros.source.program import CodeFunction

#: Functions that read a clock -> the unit in which they count.
_CLOCKS = {
    **dict.fromkeys(("millis", "uxr_millis", "HAL_GetTick", "k_uptime_get", "k_uptime_get_32"), MILLISECOND),
    **dict.fromkeys(("micros", "esp_timer_get_time", "time_us_32", "time_us_64"), MICROSECOND),
}
_JUMPS = ("return_statement", "break_statement", "continue_statement", "goto_statement")


def interval_of(condition: Node, body: Node, number: Callable[[Node], int | None]) -> Time:
    """The least time between two executions of a branch, 0 if its condition does not keep them apart.

    The clock of the last execution has to be noted in each: `if (millis() - last > 100) { last = millis(); ... }`.

    Parameters
    ----------
    number : the value of an expression, None if it is not constant
    """
    return max((_interval(each, body, number) for each in _conjuncts(condition)), default=0)


def interval_of_macro(macro: CodeFunction, parameter: str, number: Callable[[Node], int | None]) -> Time:
    """The least time between two executions of what a macro is given for a parameter; 0 if nothing keeps them apart."""
    choices = [each for each in descendants(macro.body) if each.type == "if_statement"]
    places = [each for each in descendants(macro.body) if each.type == "identifier" and text_of(each) == parameter]
    return min((max((_within(each, place, number) for each in choices), default=0) for place in places), default=0)


def _within(choice: Node, place: Node, number: Callable[[Node], int | None]) -> Time:
    """The interval of the branch of a choice that something is in; 0 if it is not in it."""
    condition, taken = choice.child_by_field_name("condition"), choice.child_by_field_name("consequence")
    if condition is None or taken is None or not taken.start_byte <= place.start_byte < taken.end_byte:
        return 0
    return interval_of(condition, taken, number)


def _conjuncts(condition: Node) -> Iterator[Node]:
    """The parts of a condition that all have to hold."""
    condition = condition.child_by_field_name("value") or condition
    if condition.type == "parenthesized_expression" and condition.named_children:
        yield from _conjuncts(condition.named_children[0])
        return
    left, right = condition.child_by_field_name("left"), condition.child_by_field_name("right")
    if left is not None and right is not None and _operator(condition) == "&&":
        yield from _conjuncts(left)
        yield from _conjuncts(right)
        return
    yield condition


def _interval(condition: Node, body: Node, number: Callable[[Node], int | None]) -> Time:
    passed, least = condition.child_by_field_name("left"), condition.child_by_field_name("right")
    if passed is None or least is None or _operator(condition) not in (">", ">=") or _operator(passed) != "-":
        return 0
    clock, last = passed.child_by_field_name("left"), passed.child_by_field_name("right")
    if clock is None or last is None or _called(clock) not in _CLOCKS or not _notes(text_of(last), _called(clock), body):
        return 0
    stated = number(least)
    # A clock that counts whole units shows n of them already after more than n - 1.
    units = 0 if stated is None else stated - (_operator(condition) == ">=")
    return Time(max(0, units) * _CLOCKS[_called(clock)])


def _notes(last: str, clock: str, body: Node) -> bool:
    """Whether a branch always sets a variable to a clock: first, or at any place if nothing leaves it before."""
    statements = body.named_children if body.type == "compound_statement" else [body]
    setting = [each for each in statements if _sets(each, last, clock)]
    return bool(setting) and (setting[0] == statements[0] or not any(each.type in _JUMPS for each in descendants(body)))


def _sets(statement: Node, name: str, clock: str) -> bool:
    assignment = (
        statement.named_children[0] if statement.type == "expression_statement" and statement.named_children else statement
    )
    left, right = assignment.child_by_field_name("left"), assignment.child_by_field_name("right")
    if assignment.type != "assignment_expression" or left is None or right is None:
        return False
    return _operator(assignment) == "=" and text_of(left) == name and _called(right) == clock


def _operator(node: Node) -> str:
    operator = node.child_by_field_name("operator")
    return "" if operator is None else text_of(operator)


def _called(node: Node) -> str:
    function = node.child_by_field_name("function") if node.type == "call_expression" else None
    return "" if function is None else text_of(function).rpartition("::")[2]
