"""Whether runnables are executed in the order that a constraint requires: in each job, or across processes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import takewhile

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import without_number
from amalthea_uros.perf.constraints import OrderConstraint, Ordering
from amalthea_uros.perf.events import ProcessChange, ProcessEvent, RunnableChange
from amalthea_uros.simulate.metrics.extremes import LimitedQuantity
from amalthea_uros.simulate.program.watches import EventSource
from amalthea_uros.timing.dataflow.runnable_order import satisfies_order


@dataclass(slots=True)
class RunnableOrder:
    """The calls of the jobs of a process, each job on its own.

    Attributes
    ----------
    sources : of the process, in the order of their numbers in `add`
    base : time units in a picosecond
    jobs : number of jobs that called one of the runnables, or more
    wrong : number of those in another order
    """

    constraint: OrderConstraint
    process: str
    sources: Sequence[EventSource]
    base: int
    jobs: int = 0
    wrong: int = 0
    _first_wrong: int = -1
    _calls: list[int] = field(default_factory=list)
    #: Whether a sequence of calls has the order; None if the constraint is not about it.
    _known: dict[tuple[int, ...], bool | None] = field(default_factory=dict)

    def add(self, times: Numbers, which: Numbers) -> None:
        """Take starts of calls and jobs and ends of jobs in, in the order in which they occurred."""
        for time, number in zip(times.tolist(), which.tolist(), strict=True):
            source = self.sources[number]
            if source.kind is not ProcessEvent:
                self._calls.append(number)
                continue
            if source.change is ProcessChange.TERMINATE:
                self._end_job(time)
            self._calls.clear()

    def _end_job(self, time: int) -> None:
        calls = tuple(self._calls)
        if calls not in self._known:
            called = [self.sources[number].name for number in calls]
            is_limited = any(name in group for group in self.constraint.groups for name in called)
            self._known[calls] = satisfies_order(called, self.constraint) if is_limited else None
        is_right = self._known[calls]
        self.jobs += is_right is not None
        if is_right is False:
            self.wrong += 1
            self._first_wrong = time if self._first_wrong < 0 else self._first_wrong

    def quantities(self, _end: int) -> Iterator[LimitedQuantity]:
        """What was observed."""
        values = ObservedValues.only(self.wrong) if self.jobs else ObservedValues(reason="no job called one of the runnables")
        if self.wrong:
            violation = f"{self.wrong:,} of {self.jobs:,} jobs in another order"
            values = replace(values, violation=violation, violated_at=Fraction(self._first_wrong, self.base))
        yield LimitedQuantity(without_number(self.constraint, self.process, "order of runnables"), values)


@dataclass(slots=True)
class ExecutionOrder:
    """The executions of runnables in several processes, of which those with the same number belong together.

    Attributes
    ----------
    sources : starts and ends of the runnables, in the order of their numbers in `add`
    base : time units in a picosecond
    """

    constraint: OrderConstraint
    processes: Sequence[str]
    sources: Sequence[EventSource]
    base: int
    _started: Counter[str] = field(default_factory=Counter)
    _ended: Counter[str] = field(default_factory=Counter)
    _wrong: int = 0
    _first_wrong: int = -1

    def add(self, times: Numbers, which: Numbers) -> None:
        """Take starts and ends in, in the order of time; what ends at the time at which something starts, ends before it."""
        is_start = np.array([source.change is RunnableChange.START for source in self.sources], bool)
        order = np.lexsort((is_start[which], times))
        for time, number in zip(times[order].tolist(), which[order].tolist(), strict=True):
            name = self.sources[number].name
            if not is_start[number]:
                self._ended[name] += 1
                continue
            if any(self._ended[before] <= self._started[name] for before in self._before(name)):
                self._wrong += 1
                self._first_wrong = time if self._first_wrong < 0 else self._first_wrong
            self._started[name] += 1

    def _before(self, name: str) -> Iterator[str]:
        """The runnables that have to end before another one starts."""
        for group in takewhile(lambda group: name not in group, self.constraint.groups):
            yield from group

    def quantities(self, _end: int) -> Iterator[LimitedQuantity]:
        """What was observed."""
        executions = self._started.total()
        is_known = executions and (self._wrong or self.constraint.ordering is Ordering.SUCCESSOR)
        reason = (
            "only the order of these runnables is observed, not what is executed in between"
            if executions
            else "none of them ran"
        )
        values = ObservedValues.only(self._wrong) if is_known else ObservedValues(reason=reason)
        if self._wrong:
            violation = f"{self._wrong:,} of {executions:,} executions in another order"
            values = replace(values, violation=violation, violated_at=Fraction(self._first_wrong, self.base))
        yield LimitedQuantity(without_number(self.constraint, ", ".join(self.processes), "order of runnables"), values)
