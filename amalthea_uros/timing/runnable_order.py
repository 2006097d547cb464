"""Whether a process calls runnables in the order that an order constraint requires."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.perf.constraints import OrderConstraint, Ordering


def satisfies_order(called: Sequence[str], constraint: OrderConstraint) -> bool:
    """Whether the groups follow each other and each runnable is called once; the order within a group is free."""
    members = [set(group) for group in constraint.groups]
    position = [next((i for i, group in enumerate(members) if name in group), None) for name in called]
    found = [(i, number) for i, number in enumerate(position) if number is not None]
    numbers = [number for _, number in found]
    if numbers != sorted(numbers) or len(found) != sum(map(len, members)):
        return False
    if constraint.ordering is Ordering.SUCCESSOR:
        return True
    first, last = found[0][0], found[-1][0]
    if last - first + 1 != len(found):
        return False
    match constraint.ordering:
        case Ordering.IMMEDIATE_AT_START:
            return first == 0
        case Ordering.IMMEDIATE_AT_END:
            return last == len(called) - 1
    return True
