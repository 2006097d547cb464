"""Counters, conditions and modes."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *

#: Relations between two values.
EQUAL, NOT_EQUAL, LESS, LESS_OR_EQUAL, GREATER, GREATER_OR_EQUAL = range(6)


def counts(m: Memory, counter: int) -> bool:
    """Whether this occurrence takes effect; without a counter (0), each one does."""
    if counter == 0:
        return True
    number, first = m[counter + COUNTED] + 1, m[counter + FIRST_EFFECT]
    m[counter + COUNTED] = number
    return number >= first and (number - first) % m[counter + EVERY] == 0


def holds(m: Memory, condition: int) -> bool:
    """Whether all comparisons of at least one alternative are true."""
    for alternative in range(m[condition + ALTERNATIVES], m[condition + ALTERNATIVES_END], ALTERNATIVE_SIZE):
        is_true = True
        for comparison in range(m[alternative + COMPARISONS], m[alternative + COMPARISONS_END], COMPARISON_SIZE):
            is_true = is_true and _is_true(m, comparison)
        if is_true:
            return True
    return False


def _is_true(m: Memory, comparison: int) -> bool:
    """Whether a comparison of a value in memory with another one, or with a constant, is true."""
    relation, left = m[comparison + RELATION], m[m[comparison + LEFT_VALUE]]
    other = m[comparison + RIGHT_VALUE]
    right = m[other] if other else m[comparison + RIGHT_CONSTANT]
    if relation == EQUAL:
        return left == right
    if relation == NOT_EQUAL:
        return left != right
    if relation == LESS:
        return left < right
    if relation == LESS_OR_EQUAL:
        return left <= right
    return left > right if relation == GREATER else left >= right


def set_mode(m: Memory, label: int, value: int) -> None:
    """Set a mode label, unless it is said to be constant."""
    if not m[label + IS_CONSTANT]:
        m[label + MODE_VALUE] = value


def step_mode(m: Memory, label: int, step: int) -> None:
    """Change a mode label by some steps; an enumeration ends at its first and its last literal."""
    value = m[label + MODE_VALUE] + step
    if m[label + LITERALS] > 0:
        value = max(0, min(value, m[label + LITERALS] - 1))
    set_mode(m, label, value)
