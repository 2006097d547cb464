"""All designs of a space, those with the fewest changed values first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, permutations
from math import comb

from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.optimize.candidate import Candidate
from amalthea_uros.design.optimize.space import Choice, PriorityOrder, Space

Decision = Choice | PriorityOrder


def most_changes(space: Space) -> int:
    """The greatest number of values in which a design can differ from the present one."""
    return sum(len(counts) - 1 for counts in map(_counts, _decisions(space)))


def count_with(space: Space, changes: int) -> int:
    """The number of designs with so many changed values: a coefficient of the product of one polynomial per decision."""
    product = [1]
    for counts in map(_counts, _decisions(space)):
        longer = [0] * min(changes + 1, len(product) + len(counts) - 1)
        for i, one in enumerate(product):
            for j, other in enumerate(counts[: len(longer) - i]):
                longer[i + j] += one * other
        product = longer
    return product[changes] if changes < len(product) else 0


def designs_with(space: Space, changes: int) -> Iterator[Candidate]:
    """The designs with so many changed values, always in the same order."""
    for found in _combined(_decisions(space), changes):
        yield tuple(sorted(found, key=lambda change: change.target))


def _decisions(space: Space) -> Sequence[Decision]:
    return [*(choice for choice in space.choices if len(choice.options) > 1), *space.orders]


def _counts(decision: Decision) -> list[int]:
    """The number of ways to change 0, 1, 2, ... values of a decision."""
    if isinstance(decision, Choice):
        return [1, len(decision.options) - 1]
    size = len(decision.tasks)
    derangements = [1, 0]
    for number in range(2, size + 1):
        derangements.append((number - 1) * (derangements[-1] + derangements[-2]))
    return [comb(size, moved) * derangements[moved] for moved in range(size + 1)]


def _combined(decisions: Sequence[Decision], changes: int) -> Iterator[tuple[Change, ...]]:
    if changes == 0:
        yield ()
        return
    for position, decision in enumerate(decisions):
        later = decisions[position + 1 :]
        for own in range(1, min(changes, len(_counts(decision)) - 1) + 1):
            for part in _changed(decision, own):
                yield from (part + rest for rest in _combined(later, changes - own))


def _changed(decision: Decision, changes: int) -> Iterator[tuple[Change, ...]]:
    """The ways to change exactly so many values of a decision."""
    if isinstance(decision, Choice):
        return ((Change(decision.object, decision.key, value),) for value in decision.options[1:])
    return _moved(decision, changes)


def _moved(order: PriorityOrder, moved: int) -> Iterator[tuple[Change, ...]]:
    """The orders in which exactly so many tasks have another place."""
    for places in combinations(range(len(order.tasks)), moved):
        for sources in permutations(places):
            if all(place != source for place, source in zip(places, sources, strict=True)):
                yield tuple(
                    Change(order.tasks[source], "priority", str(order.numbers[place]))
                    for place, source in zip(places, sources, strict=True)
                )
