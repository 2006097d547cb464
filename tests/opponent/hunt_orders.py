"""Bounds that hold for any order of priorities or deadlines, against all orders of many random systems.

`python -m opponent.hunt_orders [SYSTEMS] [SEED]` with `tests` and `tests/analyze` on the path: each system of two to four tasks on one
core is simulated in every order of distinct priorities, with deadlines of a grid, and with every place of those that have no priority.
"""

import sys
from itertools import permutations, product
from random import Random

from test_unknown_order import analysed, places, played, worst

from amalthea_uros.perf.os import Policy
from amalthea_uros.units import MICROSECOND as US

PERIODS = (4, 5, 6, 8, 10, 12)


def random_tasks(random):
    """Tasks of (period, demand, whether they can be preempted) that do not overload the core."""
    while True:
        tasks = [(random.choice(PERIODS), random.randint(1, 4), random.random() < 0.6) for _ in range(random.randint(2, 4))]
        if sum(demand / period for period, demand, _ in tasks) <= 1:
            return tasks


def violations(tasks, offsets):
    """What exceeds the bounds: how it was played, and the response times with the bounds."""
    none, stated = [None] * len(tasks), [(1, 3, None)[sum(task[:2]) % 3] for task in tasks]
    for policy, known, orders, deadlines in (
        (Policy.OSEK, none, permutations(range(len(tasks))), None),
        (Policy.OSEK, stated, places(stated) if None in stated else (), None),
        (Policy.EARLIEST_DEADLINE_FIRST, none, product((1, 4, 11), repeat=len(tasks)), True),
    ):
        bounds = worst(analysed(tasks, known, offsets, policy))
        for order in orders:
            seen = played(tasks, [0] * len(tasks), offsets, order) if deadlines else played(tasks, order, offsets)
            if any(bound is not None and value * US > bound for value, bound in zip(seen, bounds, strict=True)):
                yield policy, order, seen, bounds


def main(systems=2000, seed=1):
    random, found, bounded = Random(seed), 0, 0
    for _ in range(systems):
        tasks = random_tasks(random)
        offsets = [random.randrange(period) for period, _, _ in tasks]
        bounded += sum(each is not None for each in worst(analysed(tasks, [None] * len(tasks), offsets)))
        for violation in violations(tasks, offsets):
            found += 1
            print(tasks, offsets, *violation)  # noqa: T201
    print(f"{systems} systems, {bounded} bounds, {found} violations")  # noqa: T201


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
