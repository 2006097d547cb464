"""Bounds of end-to-end latencies from periods and response times: what each task of a chain adds to them, by paper.

Each bound is the sum of its terms: for each task the time until it reads, and the time from then until its output is visible.

- A. Davare, Q. Zhu, M. Di Natale, C. Pinello, S. Kanajan and A. Sangiovanni-Vincentelli, "Period optimization for hard real-time
  distributed automotive systems", DAC 2007: at each task a period of waiting and a response time. No common clock is required.
- A. Hamann, D. Dasari, S. Kramer, M. Pressler and F. Wurst, "Communication centric design in complex automotive embedded systems",
  ECRTS 2017, for logical execution time (LET): at each task a period of waiting, and a period until the output becomes visible.
- M. Dürr, G. von der Brüggen, K.-H. Chen and J.-J. Chen, "End-to-end timing analysis of sporadic cause-effect chains in distributed
  systems", ACM Transactions on Embedded Computing Systems 18(5s), 2019, theorems 5.4 and 5.10. A writer that preempts its reader on
  the same core has written before that can read, so that its response time does not count.
- T. Kloda, A. Bertout and Y. Sorel, "Latency analysis for data chains of real-time periodic tasks", ETFA 2018: for each release of
  the first task the next release of each further one, after the response time of the previous one unless that preempts it.
- M. Becker, D. Dasari, S. Mubeen, M. Behnam and T. Nolte, "End-to-end timing analysis of cause-effect chains in automotive embedded
  systems", Journal of Systems Architecture 80, 2017: a job can read until its latest start, and the output of a job can be read until
  the next one has ended; the last reachable job of each task gives the longest path.
- R. Bi, X. Liu, J. Ren, P. Wang, H. Lv and G. Tan, "Efficient maximum data age analysis for cause-effect chains in automotive
  systems", DAC 2022: the releases of two periodic tasks are multiples of the greatest common divisor of their periods apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from math import gcd, lcm
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

DAVARE, HAMANN, DUERR = "Davare and others 2007", "Hamann and others 2017", "Dürr and others 2019"
KLODA, BECKER, BI = "Kloda, Bertout, Sorel 2018", "Becker and others 2017", "Bi and others 2022"
#: Bounds that examine all jobs of a hyperperiod are not computed for more jobs.
MAX_JOBS = 10_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainTask:
    """A task in a chain as the bounds see it: without a schedule, only activation, response time and priority.

    Attributes
    ----------
    period : maximum time between two releases, if there is one (`is_regular`)
    response : worst-case response time
    offset : of the first release; None if releases are unknown
    first_release : the latest time of it, also if later ones are unknown
    preempts_reader : whether its jobs preempt those of the next task on the same core
    """

    name: str = ""
    period: Time
    response: Time
    is_regular: bool = True
    offset: Time | None = 0
    first_release: Time = 0
    preempts_reader: bool = False

    @property
    def response_before_read(self) -> Time:
        """How long after its release the next task may read before its output is there."""
        return 0 if self.preempts_reader else self.response


class Term(NamedTuple):
    """The contribution of one task."""

    wait: Time
    run: Time


def total(terms: Iterable[Term]) -> Time:
    """The bound that terms add up to."""
    return sum(wait + run for wait, run in terms)


# Maximum reaction times


def davare(tasks: Sequence[ChainTask]) -> list[Term]:
    """Tasks with any activations that have a maximum time between them."""
    return [Term(task.period, task.response) for task in tasks]


def hamann(tasks: Sequence[ChainTask]) -> list[Term]:
    """Periodic tasks under logical execution time."""
    return [Term(task.period, task.period) for task in tasks]


def duerr(tasks: Sequence[ChainTask]) -> list[Term]:
    """Sporadic tasks whose jobs end before the next one is released."""
    found, wait = [], tasks[0].period
    for task, reader in pairwise(tasks):
        # The reader waits a period, during which a writer that preempts it also responds.
        run = task.response if not task.preempts_reader or task.response > reader.period else 0
        found.append(Term(wait, run))
        wait = 0 if task.preempts_reader and run else reader.period
    return [*found, Term(wait, tasks[-1].response)]


def kloda(tasks: Sequence[ChainTask]) -> list[Term] | None:
    """Periodic tasks with known releases; None if these are unknown or too many."""

    def next_release(release: Numbers, task: ChainTask, reader: ChainTask) -> Numbers:
        written = release + task.response_before_read - (reader.offset or 0)
        following: Numbers = (reader.offset or 0) + -(-written // reader.period) * reader.period
        return following

    steps = _longest_path(tasks, next_release)
    if steps is None:
        return None
    found, wait = [], tasks[0].period
    for task, step in zip(tasks, steps, strict=False):
        found.append(Term(wait, task.response_before_read))
        wait = step - task.response_before_read
    return [*found, Term(wait, tasks[-1].response)]


# Maximum reduced data ages


def duerr_data_age(tasks: Sequence[ChainTask]) -> list[Term]:
    """Sporadic tasks whose jobs end before the next one is released."""
    # The data of a task are read until it writes again.
    waits = [0, *(task.period for task in tasks[:-1])]
    runs = [*(task.response_before_read for task in tasks[:-1]), tasks[-1].response]
    return [Term(wait, run) for wait, run in zip(waits, runs, strict=True)]


def becker(tasks: Sequence[ChainTask]) -> list[Term] | None:
    """Periodic tasks with known releases; None if these are unknown or too many."""

    def last_reachable(release: Numbers, task: ChainTask, reader: ChainTask) -> Numbers:
        overwritten = release + task.period + task.response - (reader.offset or 0)
        reachable: Numbers = (reader.offset or 0) + (-(-overwritten // reader.period) - 1) * reader.period
        return reachable

    steps = _longest_path(tasks, last_reachable)
    if steps is None:
        return None
    # From release to release: the last reachable job of a reader may be released before the writer has ended.
    waits = [0, *steps]
    return [*(Term(wait, 0) for wait in waits[:-1]), Term(waits[-1], tasks[-1].response)]


def on_grids(tasks: Sequence[ChainTask]) -> bool:
    """Whether the releases of each two tasks in a row are multiples of the greatest common divisor of their periods apart."""
    return all(
        ((task.offset or 0) - (reader.offset or 0)) % gcd(task.period, reader.period) == 0 for task, reader in pairwise(tasks)
    )


def bi(tasks: Sequence[ChainTask]) -> list[Term]:
    """Periodic tasks whose releases are on grids, such as those that are released together."""
    found, wait = [], 0
    for task, reader in pairwise(tasks):
        grid, run = gcd(task.period, reader.period), task.response_before_read
        found.append(Term(wait, run))
        wait = task.period - (run % grid or grid)
    return [*found, Term(wait, tasks[-1].response)]


#: By the source of a bound: of the maximum reaction time, and of the maximum reduced data age.
REACTION_TIME: Mapping[str, Callable[[Sequence[ChainTask]], list[Term] | None]] = {
    DAVARE: davare,
    DUERR: duerr,
    HAMANN: hamann,
    KLODA: kloda,
}
REDUCED_DATA_AGE: Mapping[str, Callable[[Sequence[ChainTask]], list[Term] | None]] = {
    DUERR: duerr_data_age,
    BECKER: becker,
    BI: bi,
}


def _longest_path(
    tasks: Sequence[ChainTask], following: Callable[[Numbers, ChainTask, ChainTask], Numbers]
) -> list[Time] | None:
    """The times from each release to that of the next task on the longest path; None if releases are unknown or too many."""
    first = _first_releases(tasks)
    if first is None:
        return None
    paths = [first]
    for task, reader in pairwise(tasks):
        paths.append(following(paths[-1], task, reader))
    worst = int((paths[-1] - first).argmax())
    return [int(then[worst] - release[worst]) for release, then in pairwise(paths)]


def _first_releases(tasks: Sequence[ChainTask]) -> Numbers | None:
    """The releases of the first task in one hyperperiod of the chain; None if they are unknown or too many."""
    if any(task.offset is None for task in tasks):
        return None
    cycle = lcm(*(task.period for task in tasks))
    count = cycle // tasks[0].period
    steady_state_start = max(task.offset or 0 for task in tasks)
    if count * len(tasks) > MAX_JOBS or steady_state_start + 2 * cycle > LIMIT:
        return None
    offset = tasks[0].offset or 0
    lead = -(-(steady_state_start - offset) // tasks[0].period)
    releases: Numbers = offset + tasks[0].period * (lead + np.arange(count, dtype=np.int64))
    return releases
