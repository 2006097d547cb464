"""The terms of the bounds: for each task the time until it reads, and the time from then until its output is visible.

They add up to the bound, so that they say which task contributes how much.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from math import gcd
from typing import NamedTuple

from amalthea_uros.analyze.chains.bounds import becker, bi, davare, duerr, hamann, kloda
from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask, first_releases
from amalthea_uros.units import Time


class Term(NamedTuple):
    """The contribution of one task."""

    wait: Time
    run: Time


def _davare(tasks: Sequence[ChainTask]) -> list[Term]:
    return [Term(task.period, task.response) for task in tasks]


def _hamann(tasks: Sequence[ChainTask]) -> list[Term]:
    return [Term(task.period, task.period) for task in tasks]


def _duerr(tasks: Sequence[ChainTask]) -> list[Term]:
    found, wait = [], tasks[0].period
    for task, reader in pairwise(tasks):
        # The reader waits a period, during which a writer that preempts it also responds.
        run = task.response if not task.preempts_reader or task.response > reader.period else 0
        found.append(Term(wait, run))
        wait = 0 if task.preempts_reader and run else reader.period
    return [*found, Term(wait, tasks[-1].response)]


def _kloda(tasks: Sequence[ChainTask]) -> list[Term]:
    first = first_releases(tasks)
    assert first is not None
    paths = [first]
    for task, reader in pairwise(tasks):
        written = paths[-1] + (0 if task.preempts_reader else task.response) - (reader.offset or 0)
        paths.append((reader.offset or 0) + -(-written // reader.period) * reader.period)
    worst = int((paths[-1] - first).argmax())
    found, wait = [], tasks[0].period
    for task, (release, then) in zip(tasks, pairwise(int(path[worst]) for path in paths), strict=False):
        run = 0 if task.preempts_reader else task.response
        found.append(Term(wait, run))
        wait = then - release - run
    return [*found, Term(wait, tasks[-1].response)]


def _duerr_data_age(tasks: Sequence[ChainTask]) -> list[Term]:
    # The data of a task are read until it writes again.
    waits = [0, *(task.period for task in tasks[:-1])]
    runs = [0 if task.preempts_reader else task.response for task in tasks[:-1]]
    return [Term(wait, run) for wait, run in zip(waits, [*runs, tasks[-1].response], strict=True)]


def _becker(tasks: Sequence[ChainTask]) -> list[Term]:
    first = first_releases(tasks)
    assert first is not None
    paths = [first]
    for task, reader in pairwise(tasks):
        overwritten = paths[-1] + task.period + task.response - (reader.offset or 0)
        paths.append((reader.offset or 0) + (-(-overwritten // reader.period) - 1) * reader.period)
    worst = int((paths[-1] - first).argmax())
    # From release to release: the last reachable job of a reader may be released before the writer has ended.
    waits = [0, *(int(then[worst] - release[worst]) for release, then in pairwise(paths))]
    return [*(Term(wait, 0) for wait in waits[:-1]), Term(waits[-1], tasks[-1].response)]


def _bi(tasks: Sequence[ChainTask]) -> list[Term]:
    found, wait = [], 0
    for task, reader in pairwise(tasks):
        grid = gcd(task.period, reader.period)
        run = 0 if task.preempts_reader else task.response
        found.append(Term(wait, run))
        wait = task.period - (run % grid or grid)
    return [*found, Term(wait, tasks[-1].response)]


#: By the source of a bound: of the maximum reaction time, and of the maximum reduced data age.
REACTION_TIME: Mapping[str, Callable[[Sequence[ChainTask]], list[Term]]] = {
    davare.SOURCE: _davare,
    duerr.SOURCE: _duerr,
    hamann.SOURCE: _hamann,
    kloda.SOURCE: _kloda,
}
REDUCED_DATA_AGE: Mapping[str, Callable[[Sequence[ChainTask]], list[Term]]] = {
    duerr.SOURCE: _duerr_data_age,
    becker.SOURCE: _becker,
    bi.SOURCE: _bi,
}
