"""The tightest limit, and failures that are counted once."""

from dataclasses import dataclass
from fractions import Fraction
from math import inf

import pytest

from amalthea_uros.judge.causes import causes, distinct
from amalthea_uros.judge.limits import SystemLimit
from amalthea_uros.judge.margins import share_left, tightest
from amalthea_uros.perf.software import Task

US, MS = 10**6, 10**9


@dataclass(frozen=True)
class Item:
    object: str
    quantity: str = "response time"
    value: int | None = None
    limit: int | None = None
    is_upper: bool = True
    overloaded_core: str | None = None
    stated: SystemLimit | None = None


@dataclass(frozen=True)
class Core:
    name: str


@pytest.mark.parametrize(
    ("value", "limit", "is_upper", "share"),
    [
        (980, 1000, True, Fraction(2, 100)),
        (1500, 1000, True, Fraction(-1, 3)),
        (25, 20, False, Fraction(1, 5)),
        (15, 20, False, Fraction(-1, 4)),
        # A jitter of at most nothing has nothing left; a time of at least nothing cannot be missed.
        (0, 0, True, 0),
        (0, 0, False, inf),
        # A difference of times of at least -20.
        (-15, -20, False, Fraction(1, 4)),
        (-25, -20, False, Fraction(-1, 5)),
        # A lateness.
        (-971, 0, True, 1),
        (None, 20, True, None),
        (20, None, True, None),
    ],
)
def test_the_share_that_is_left(value, limit, is_upper, share):
    assert share_left(Item("T", value=value, limit=limit, is_upper=is_upper)) == share


def test_the_tightest_has_the_smallest_share_left_not_the_least_time():
    # 20 ms of 1 s, and 990 us of 1 ms.
    nearly, hardly = Item("slow", value=980 * MS, limit=1000 * MS), Item("fast", value=10 * US, limit=MS)
    assert tightest([hardly, nearly, Item("unknown")]) is nearly
    assert tightest([Item("unknown")]) is None


def test_a_late_task_and_the_requirements_on_its_response_time_are_one_failure():
    late = Item("T", "response time, deadline")
    others = [Item("T"), Item("T"), Item("T", "response time jitter"), Item("T", is_upper=False), Item("U")]
    assert distinct([late, *others]) == [late, *others[2:]]


def test_what_an_overload_makes_endless_is_a_consequence():
    overloaded = Item("U", "response time, period", overloaded_core="core")
    below = Item("V", "response time, period", overloaded_core="core")
    way, other = (stated(name) for name in ("way", "other"))
    late = Item("W", "response time, period")
    found = causes([], [way, overloaded, Item("U"), below, late], [other, Item("X")], lambda limit: {"U"})
    assert [(cause.root, cause.consequences) for cause in found] == [(overloaded, (below, way, other)), (late, ())]


def test_each_overloaded_core_is_a_failure():
    cores, late = [Core("a"), Core("b")], Item("T")
    assert [cause.root for cause in causes(cores, [late], [], lambda limit: set())] == [*cores, late]


def stated(name):
    limit = SystemLimit(name=name, object=name, quantity="reaction", limit=1, item=Task(name=name))
    return Item(name, "reaction", stated=limit)
