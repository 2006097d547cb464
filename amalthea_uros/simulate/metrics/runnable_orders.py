"""Whether runnables are executed in the order that a constraint requires: in each job, or across processes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import takewhile

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import without_number
from amalthea_uros.perf.constraints import OrderConstraint, Ordering
from amalthea_uros.perf.events import ProcessChange, ProcessEvent, RunnableChange
from amalthea_uros.simulate.metrics.extremes import ConstraintMetrics, LimitedQuantity
from amalthea_uros.simulate.program.watches import EventSource
from amalthea_uros.timing.dataflow.runnable_order import satisfies_order


@dataclass(slots=True)
class OrderMetrics(ConstraintMetrics):
    """What is executed in another order than that of a constraint.

    Attributes
    ----------
    processes : their names
    sources : of the occurrences, in the order of their numbers in `add`
    wrong : number of jobs or executions in another order
    """

    constraint: OrderConstraint
    processes: str = field(kw_only=True)
    sources: Sequence[EventSource] = field(kw_only=True)
    wrong: int = 0
    _first_wrong: int = -1

    def _note_wrong(self, time: int) -> None:
        self.wrong += 1
        self._first_wrong = time if self._first_wrong < 0 else self._first_wrong

    def quantities(self, end: int) -> Iterator[LimitedQuantity]:  # noqa: D102
        yield LimitedQuantity(without_number(self.constraint, self.processes), self._values(end))

    def _of(self, total: str, reason: str) -> ObservedValues:
        """The number of those in another order, of all that there were, or the reason why it is not known."""
        values = ObservedValues(reason=reason) if reason and not self.wrong else ObservedValues.only(self.wrong)
        if self.wrong:
            violation = f"{self.wrong:,} of {total} in another order"
            values = replace(values, violation=violation, violated_at=Fraction(self._first_wrong, self.base))
        return values


@dataclass(slots=True)
class RunnableOrder(OrderMetrics):
    """The calls of the jobs of a process, each job on its own.

    Attributes
    ----------
    jobs : number of jobs that called one of the runnables, or more
    """

    jobs: int = 0
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
            self._note_wrong(time)

    def _values(self, end: int) -> ObservedValues:
        return self._of(f"{self.jobs:,} jobs", "" if self.jobs else "no job called one of the runnables")


@dataclass(slots=True)
class ExecutionOrder(OrderMetrics):
    """The executions of runnables in several processes, of which those with the same number belong together.

    Attributes
    ----------
    sources : starts and ends of the runnables
    """

    _started: Counter[str] = field(default_factory=Counter)
    _ended: Counter[str] = field(default_factory=Counter)

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
                self._note_wrong(time)
            self._started[name] += 1

    def _before(self, name: str) -> Iterator[str]:
        """The runnables that have to end before another one starts."""
        for group in takewhile(lambda group: name not in group, self.constraint.groups):
            yield from group

    def _values(self, end: int) -> ObservedValues:
        executions, reason = self._started.total(), ""
        if not executions:
            reason = "none of them ran"
        elif self.constraint.ordering is not Ordering.SUCCESSOR:
            reason = "only the order of these runnables is observed, not what is executed in between"
        return self._of(f"{executions:,} executions", reason)
