"""Random task sets for experiments: utilizations that are uniformly distributed over all sets of a total, and periods.

Sources
-------
E. Bini, G. Buttazzo: Measuring the performance of schedulability tests. Real-Time Systems 30, 2005 (UUniFast).
R. Davis, A. Burns: Priority assignment for global fixed priority pre-emptive scheduling in multiprocessor real-time systems. RTSS 2009
(UUniFast-Discard).
P. Emberson, R. Stafford, R. Davis: Techniques for the synthesis of multiprocessor tasksets. WATERS 2010 (log-uniform periods).
S. Kramer, D. Ziegenbein, A. Hamann: Real world automotive benchmarks for free. WATERS 2015, table III (shares of periods).
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, exp, log
from random import Random
from typing import Literal, TypeAlias

from amalthea_uros.design.task_parameters import TaskParameters, task
from amalthea_uros.design.taskset import taskset
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.stated_times import TimeLike, stated_time
from amalthea_uros.units import MILLISECOND, Duration, Time

#: A seed, which gives the same numbers again, or a generator that continues.
Randomness: TypeAlias = int | Random

#: Milliseconds and the share of the runnables in percent; 15 % more are activated by the angle of the crankshaft.
AUTOMOTIVE_PERIODS = {1: 3, 2: 2, 5: 2, 10: 25, 20: 25, 50: 3, 100: 20, 200: 1, 1000: 4}

_MOST_TRIES = 10_000


def uunifast(count: int, utilization: float, seed: Randomness) -> list[float]:
    """Utilizations of tasks with a given sum, all sets of which are equally probable (UUniFast).

    >>> shares = uunifast(4, 0.8, seed=1)
    >>> len(shares), f"{sum(shares):.6f}"
    (4, '0.800000')

    Raises
    ------
    InvalidArgumentError : fewer than one task, or a utilization that is not positive.
    """
    _check(count, utilization)
    random = _random(seed)
    shares, rest = [], utilization
    for left in range(count - 1, 0, -1):
        following = rest * random.random() ** (1 / left)
        shares.append(rest - following)
        rest = following
    return [*shares, rest]


def uunifast_discard(count: int, utilization: float, seed: Randomness, most: float = 1.0) -> list[float]:
    """As `uunifast`, for several cores: sets in which a task has more than `most` are discarded.

    Raises
    ------
    InvalidArgumentError : as for `uunifast`, or no set was found, because `count` tasks hardly reach the utilization.
    """
    _check(count, utilization)
    random = _random(seed)
    if utilization <= count * most:
        for _ in range(_MOST_TRIES):
            shares = uunifast(count, utilization, random)
            if max(shares) <= most:
                return shares
    raise InvalidArgumentError(
        f"{count} tasks of at most {most:g} each reach a utilization of {utilization:g} never or too rarely; use more tasks"
    )


def log_uniform_periods(
    count: int, shortest: TimeLike, longest: TimeLike, seed: Randomness, granularity: TimeLike = "1 ms"
) -> list[Duration]:
    """Periods whose logarithms are uniformly distributed, so that each order of magnitude is equally frequent.

    Parameters
    ----------
    granularity : of which each period is a multiple, so that hyperperiods stay short

    Raises
    ------
    InvalidArgumentError : a time is not positive, or the longest one is shorter than the shortest one.
    """
    step = stated_time("the granularity", granularity, least=1)
    low, high = stated_time("the shortest period", shortest, least=1), stated_time("the longest period", longest, least=1)
    if high < low or low % step:
        raise InvalidArgumentError(
            "expected a shortest period that is a multiple of the granularity, and not above the longest one"
        )
    random = _random(seed)
    times = (exp(random.uniform(log(low), log(high + step))) for _ in range(count))
    return [Duration(min(high, int(time) // step * step)) for time in times]


def automotive_periods(count: int, seed: Randomness) -> list[Duration]:
    """Periods with the frequencies that were published for engine control (Kramer and others 2015), without angle-synchronous ones."""
    random = _random(seed)
    chosen = random.choices(list(AUTOMOTIVE_PERIODS), list(AUTOMOTIVE_PERIODS.values()), k=count)
    return [Duration(period * MILLISECOND) for period in chosen]


def random_tasks(
    count: int, utilization: float, seed: Randomness, *, periods: tuple[TimeLike, TimeLike] | None = None
) -> list[TaskParameters]:
    """Tasks T1, T2, ... with a total utilization: by UUniFast, with automotive periods or log-uniform ones of a range.

    Execution times are constant. They are rounded up to a nanosecond, so that the utilization is not below the given one.

    Parameters
    ----------
    periods : the shortest and the longest one; by default those of `automotive_periods`

    Raises
    ------
    InvalidArgumentError : as for `uunifast` and `log_uniform_periods`.
    """
    random = _random(seed)
    shares = uunifast(count, utilization, random)
    made = automotive_periods(count, random) if periods is None else log_uniform_periods(count, *periods, random)
    tasks = []
    for number, (share, period) in enumerate(zip(shares, made, strict=True), 1):
        time = Duration(_rounded_up(Fraction(share) * period.time))
        tasks.append(task(f"T{number}", period=period, bcet=time, wcet=time))
    return tasks


def random_taskset(
    count: int,
    utilization: float,
    seed: Randomness,
    *,
    periods: tuple[TimeLike, TimeLike] | None = None,
    policy: Literal["fixed priority", "EDF"] = "fixed priority",
) -> System:
    """A system of `random_tasks` on one core, with rate-monotonic priorities or under EDF; errors as for `random_tasks`.

    >>> analyze(random_taskset(5, 0.7, seed=1)).summary.schedulable  # doctest: +SKIP
    """
    tasks = random_tasks(count, utilization, seed, periods=periods)
    return taskset(tasks, policy=policy, priorities="rate monotonic" if policy == "fixed priority" else None)


def _rounded_up(time: Fraction) -> Time:
    return max(1, ceil(time / 1000)) * 1000


def _random(seed: Randomness) -> Random:
    return seed if isinstance(seed, Random) else Random(seed)


def _check(count: int, utilization: float) -> None:
    if count < 1:
        raise InvalidArgumentError(f"expected at least one task, not {count}")
    if not 0 < utilization < float("inf"):
        raise InvalidArgumentError(f"the utilization {utilization} is not a positive number")
