"""Latencies of chains in a multi-threaded executor of which all callbacks are reentrant, on cores of its own.

After X. Jiang, D. Ji, N. Guan, R. Li, Y. Tang and Y. Wang, "Real-time scheduling and analysis of processing chains on
multi-threaded executor in ROS 2", RTSS 2022, theorem 1: what is before the last callback of a chain waits at most for the work of
all other chains, divided by the number of threads. Its workload bound needs that no chain takes longer than its period; and a
counterexample for groups that exclude each other is known (H. Teper et al., "Thread Carefully", RTAS 2024), so that it is used for
reentrant groups only.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "carry-in of chains in a multi-threaded executor"
SOURCE = "Jiang et al. 2022"


@dataclass(frozen=True, slots=True)
class ReentrantChain:
    """A chain of which two releases are a period apart at least.

    Attributes
    ----------
    total, last : execution times of all its callbacks, and of the last one
    """

    period: Time
    total: Time
    last: Time


def latencies(chains: Sequence[ReentrantChain], threads: int) -> list[Response]:
    """The latencies of all chains of an executor; all are unknown if the assumption does not hold for one of them."""
    bounds = [_latency(index, chains, threads) for index in range(len(chains))]
    if None in bounds:
        reason = "a chain of the executor can take longer than its period, and no published method covers that"
        return [Response(worst=None, best=0, method=METHOD, source=SOURCE, reason=reason) for _ in chains]
    return [Response(worst=bound, best=0, method=METHOD, source=SOURCE, claim=Claim.BOUND) for bound in bounds]


def _latency(index: int, chains: Sequence[ReentrantChain], threads: int) -> Time | None:
    """The least fixed point for a chain; None if it exceeds the period."""
    chain = chains[index]
    others = [other for number, other in enumerate(chains) if number != index]
    before = chain.total - chain.last
    while before + chain.last <= chain.period:
        # What is released in the instant in which the last callback could start still counts.
        interference = sum(_workload(other, before + 1) for other in others)
        reached = chain.total - chain.last - (-interference // threads)
        if reached <= before:
            return before + chain.last
        before = reached
    return None


def _workload(chain: ReentrantChain, window: Time) -> Time:
    """The most that a chain executes in a window, if each of its jobs ends within its period."""
    whole, rest = divmod(window + chain.period - chain.total, chain.period)
    return whole * chain.total + min(chain.total, rest)
