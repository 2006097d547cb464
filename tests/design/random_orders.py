"""Random systems in which rate-monotonic priorities fail, and all orders that do not, without any code of the product."""

from collections.abc import Iterator, Sequence
from itertools import permutations
from random import Random


def worst_response(task: dict, above: Sequence[dict], below: Sequence[dict]) -> int | None:
    """From the nominal arrival, by the recurrence of Audsley and others 1993; None beyond the period."""
    used = {lock for each in (task, *above) for lock in each["locks"]}
    blocking = max((each["locks"][lock] for each in below for lock in used if lock in each["locks"]), default=0)
    response = -1
    found = task["C"] + blocking
    while found != response:
        response = found
        found = blocking + task["C"] + sum(-(-(response + each["J"]) // each["T"]) * each["C"] for each in above)
        if found + task["J"] > task["T"]:
            return None
    return response + task["J"]


def all_orders(tasks: Sequence[dict]) -> set[tuple[str, ...]]:
    """The orders in which all tasks meet their deadlines, the most important task first."""

    def meets(order: Sequence[dict]) -> bool:
        times = (worst_response(task, order[:place], order[place + 1 :]) for place, task in enumerate(order))
        return all(time is not None and time <= task["D"] for time, task in zip(times, order, strict=True))

    return {tuple(task["name"] for task in order) for order in permutations(tasks) if meets(order)}


def random_sets(count: int) -> Iterator[list[dict]]:
    """Systems with constrained deadlines, jitter and locks in which rate-monotonic priorities fail."""
    random = Random(1)
    while count:
        tasks = []
        for name in "ABCD"[: random.randint(3, 4)]:
            period, cost = random.choice([6, 8, 10, 12, 15, 20, 24]), random.randint(1, 4)
            deadline = random.randint(min(period, cost + 2), period)
            jitter = random.choice([0, 0, random.randint(0, deadline // 2)])
            locks = {lock: random.randint(1, cost) for lock in "RS" if random.random() < 0.2}
            tasks.append({"name": name, "C": cost, "T": period, "D": deadline, "J": jitter, "locks": locks})
        monotonic = tuple(task["name"] for task in sorted(tasks, key=lambda task: task["T"]))
        if sum(task["C"] / task["T"] for task in tasks) <= 1 and monotonic not in all_orders(tasks):
            count -= 1
            yield tasks
