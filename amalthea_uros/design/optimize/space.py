"""What may change: values on offer, and orders of priorities; a design as the values that it changes, and all designs of a space."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from itertools import combinations, permutations, product
from math import comb, factorial, prod
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.change import Change

#: The changed values, ordered by their targets, without those that are as they were: equal designs are equal candidates.
Candidate: TypeAlias = tuple[Change, ...]

#: The design as it is.
UNCHANGED: Candidate = ()


def candidate(changes: Iterable[Change], present: Mapping[str, str]) -> Candidate:
    """The candidate of some changes.

    Parameters
    ----------
    present : target -> the value as it is, written as in the changes
    """
    last = {change.target: change for change in changes}
    return tuple(change for target, change in sorted(last.items()) if present.get(target) != change.value)


class DecisionKind(StrEnum):
    """What kind of decision something is."""

    PERIOD = "period"
    OFFSET = "offset"
    PRIORITY = "priority"
    CORE = "core"
    ORDER = "order"
    PLACEMENT = "placement"
    COMMUNICATION = "communication"
    MEMORY = "memory"
    CLOCK = "clock"
    OTHER = "other"


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """One value out of several.

    Attributes
    ----------
    object, key : what is changed, as for `Change`
    options : the values as text, that of the present design first
    """

    object: str
    key: str
    kind: DecisionKind
    options: tuple[str, ...]

    @property
    def target(self) -> str:
        """The object and the key, such as "Executor_Task.period"."""
        return f"{self.object}.{self.key}".removeprefix(".")


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorityOrder:
    """Distinct priorities for the tasks of a scheduler, in any order.

    Attributes
    ----------
    tasks : whose priorities may change, in the present order, the most important first
    numbers : the priorities that they share out, the highest first; as many as there are tasks
    """

    scheduler: str
    tasks: tuple[str, ...]
    numbers: tuple[int, ...]

    def changes(self, tasks: Sequence[str]) -> tuple[Change, ...]:
        """The priorities of an order of the tasks, the most important first."""
        return tuple(Change(task, "priority", str(number)) for task, number in zip(tasks, self.numbers, strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class Space:
    """All designs that may be proposed: each combination of options, with each order of priorities."""

    choices: tuple[Choice, ...] = ()
    orders: tuple[PriorityOrder, ...] = ()

    @property
    def size(self) -> int:
        """The number of designs, the present one included."""
        return prod(len(choice.options) for choice in self.choices) * prod(factorial(len(each.tasks)) for each in self.orders)


Decision = Choice | PriorityOrder


def combinations_of(choices: Sequence[Choice]) -> Iterator[Candidate]:
    """Each combination of the options of some choices; the first option of a choice is no change."""
    ordered = sorted(choices, key=lambda choice: choice.target)
    for values in product(*(choice.options for choice in ordered)):
        yield tuple(
            Change(choice.object, choice.key, value)
            for choice, value in zip(ordered, values, strict=True)
            if value != choice.options[0]
        )


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
