"""What observes the constraints of a system, and labels: each gets the occurrences that it is about, chunk by chunk."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.judge.limits import NO_LIMIT, EventConstraint, limits_of
from amalthea_uros.perf.constraints import (
    ChainSynchronization,
    Constraint,
    DelayConstraint,
    EventSynchronization,
    OrderConstraint,
    RepetitionConstraint,
)
from amalthea_uros.perf.events import Event, EventSet, ProcessChange, ProcessEvent, RunnableEvent, SemaphoreEvent
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.kernel.layout import Observation
from amalthea_uros.simulate.metrics.event_constraints import AllOccurrences, Repetitions, SubsequentOccurrences, delays
from amalthea_uros.simulate.metrics.extremes import ConstraintMetrics, LimitedQuantity
from amalthea_uros.simulate.metrics.label_values import DataAges, LabelAges, LabelValues, Reading
from amalthea_uros.simulate.metrics.runnable_orders import ExecutionOrder, OrderMetrics, RunnableOrder
from amalthea_uros.simulate.observations import LabelObservation
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.build import KernelProgram
from amalthea_uros.simulate.program.watches import (
    EventSource,
    event_names,
    events_of_order,
    is_of_label,
    is_of_order,
    is_source,
)
from amalthea_uros.timing.dataflow.events import EventLocator
from amalthea_uros.timing.dataflow.runnable_order import order_scope


@dataclass(slots=True)
class SourceTable:
    """Which rows are occurrences of something: those of some sources, of some of them on one core only."""

    sources: Flags
    core: int = -1
    off_core: Flags | None = None

    def places(self, rows: Numbers) -> Numbers:
        """The indices of the rows."""
        numbers = rows[:, Observation.ROUTE]
        is_found = self.sources[numbers]
        if self.off_core is not None:
            is_found &= (rows[:, Observation.STAMP] == self.core) | self.off_core[numbers]
        return np.flatnonzero(is_found)


@dataclass(slots=True)
class _SetTable:
    """An event set: it occurs when all its events have occurred since it occurred last."""

    members: list[EventTable]
    _seen: set[int] = field(default_factory=set)

    def places(self, rows: Numbers) -> Numbers:
        """The indices of the rows that complete the set."""
        found = [member.places(rows) for member in self.members]
        places, which = in_order(found)
        completed: list[int] = []
        for place, member in zip(places.tolist(), which.tolist(), strict=True):
            self._seen.add(member)
            if len(self._seen) == len(self.members):
                self._seen.clear()
                completed.append(place)
        return np.array(completed, np.int64)


#: Which rows are occurrences of an event.
EventTable = SourceTable | _SetTable


@dataclass(slots=True)
class EventTables:
    """The events of a system, and the sources at which they occur in a program."""

    system: System
    sources: Sequence[EventSource]
    cores: Sequence[str]

    def table(self, name: str) -> EventTable | None:
        """Which rows are occurrences of an event; None if it occurs nowhere."""
        event = self.system.events_by_name.get(name)
        if isinstance(event, EventSet):
            members = [self.table(each) for each in dict.fromkeys(event.events) if each != name]
            found = [member for member in members if member is not None]
            return _SetTable(found) if found and len(found) == len(members) else None
        return None if event is None else self._of_sources(event)

    def _of_sources(self, event: Event) -> SourceTable | None:
        found = np.array([is_source(source, event) for source in self.sources], bool)
        if not found.any():
            return None
        core = event.core if isinstance(event, ProcessEvent | RunnableEvent | SemaphoreEvent) else None
        if core is None:
            return SourceTable(found)
        # An activation is on no core.
        off_core = np.array([source.change is ProcessChange.ACTIVATE for source in self.sources], bool)
        return SourceTable(found, self.cores.index(core) if core in self.cores else -2, off_core)


def in_order(places: Iterable[Numbers]) -> tuple[Numbers, Numbers]:
    """Several ascending lists as one, and for each entry the number of its list; at the same place the first list comes first."""
    lists = list(places)
    together = np.concatenate([np.empty(0, np.int64), *lists])
    which = np.repeat(np.arange(len(lists)), [len(each) for each in lists])
    order = np.argsort(together, kind="stable")
    return together[order], which[order]


@dataclass(slots=True)
class _Observer:
    """Gives metrics the occurrences of some tables."""

    metrics: ConstraintMetrics
    tables: list[EventTable]

    def add(self, rows: Numbers) -> None:
        """Take rows in."""
        places, which = in_order(table.places(rows) for table in self.tables)
        if len(places):
            self.metrics.add(rows[places, Observation.TIME], which)


@dataclass(slots=True)
class Observers:
    """All that observe a run.

    Attributes
    ----------
    end : of the run, in time units
    """

    system: System
    options: Options
    program: KernelProgram
    end: int
    _of_constraints: dict[int, list[_Observer]] = field(default_factory=dict)
    _reasons: dict[int, str] = field(default_factory=dict)
    _ages: dict[int, DataAges] = field(default_factory=dict)
    _labels: dict[str, LabelAges] = field(default_factory=dict)
    _events: EventLocator = field(init=False)
    _values: LabelValues = field(init=False)
    _of_values: SourceTable = field(init=False)
    #: Rows of the latest instant: others of the same instant can follow.
    _kept: Numbers = field(default_factory=lambda: np.empty((0, len(Observation)), np.int64))

    def __post_init__(self) -> None:
        constraints, base = self.system.constraints, self.program.units
        self._events = EventLocator(self.system)
        tables = EventTables(self.system, self.program.sources, tuple(self.program.cores))
        for constraint in constraints.constraints:
            self._observe(constraint, tables)
        for order in constraints.orders:
            self._observe_order(order)
        self._ages = {id(age): DataAges(age, base) for age in constraints.data_ages}
        labels = self.options.watched_labels(self.system)
        self._labels = {label: LabelAges(label, base) for label in labels}
        every = list(dict.fromkeys((*labels, *(age.label for age in constraints.data_ages))))
        self._values = LabelValues(every, self.program.sources, self.options.settings.communication)
        self._of_values = self._table(lambda source: is_of_label(source, every))

    def _table(self, is_wanted: Callable[[EventSource], bool]) -> SourceTable:
        return SourceTable(np.array([is_wanted(source) for source in self.program.sources], bool))

    def _observe(self, constraint: Constraint, tables: EventTables) -> None:
        names = event_names(constraint, self.system)
        found = [tables.table(name) for name in names]
        missing = [name for name, table in zip(names, found, strict=True) if table is None]
        if missing:
            self._reasons[id(constraint)] = f"the event {missing[0]!r} does not occur in what is simulated"
        elif metrics := self._metrics(constraint, names):
            self._of_constraints[id(constraint)] = [_Observer(metrics, [table for table in found if table is not None])]

    def _metrics(self, constraint: Constraint, names: Sequence[str]) -> ConstraintMetrics | None:
        base = self.program.units
        match constraint:
            case DelayConstraint():
                return delays(constraint, base)
            case RepetitionConstraint():
                return Repetitions(constraint, base)
            case EventSynchronization() | ChainSynchronization() if names:
                reading = AllOccurrences if constraint.every_occurrence else SubsequentOccurrences
                return reading(constraint, base, events=len(names))
        return None

    def _observe_order(self, order: OrderConstraint) -> None:
        scope = order_scope(order, self.system, self._events)
        together = [next(self._sources(event), None) for event in events_of_order(scope)]
        if scope.reason or None in together:
            self._reasons[id(order)] = scope.reason or "one of the processes that call the runnables is not simulated"
            return
        limited = {name for group in order.groups for name in group}
        calling = {source.process for source in self.program.sources if is_of_order(source) and source.name in limited}
        found = [self._order_of_jobs(order, process) for process in scope.alone if process in calling]
        if scope.together:
            names, sources = ", ".join(scope.processes), [source for source in together if source is not None]
            found.append(self._tables_of(ExecutionOrder(order, self.program.units, processes=names, sources=sources)))
        self._of_constraints[id(order)] = found
        if not found:
            self._reasons[id(order)] = "no process that calls its runnables is simulated"

    def _sources(self, event: Event) -> Iterator[EventSource]:
        return (source for source in self.program.sources if is_source(source, event))

    def _order_of_jobs(self, order: OrderConstraint, process: str) -> _Observer:
        sources = [source for source in self.program.sources if is_of_order(source) and source.process == process]
        return self._tables_of(RunnableOrder(order, self.program.units, processes=process, sources=sources))

    def _tables_of(self, metrics: OrderMetrics) -> _Observer:
        return _Observer(metrics, [self._table(source.__eq__) for source in metrics.sources])

    # Rows and results.

    def add(self, rows: Numbers) -> None:
        """Take rows about occurrences in, in the order of time."""
        rows = np.concatenate([self._kept, rows])
        if len(rows):
            complete = int(np.searchsorted(rows[:, Observation.TIME], rows[-1, Observation.TIME]))
            self._kept = rows[complete:].copy()
            self._add(rows[:complete])

    def finish(self) -> None:
        """Take in what is left at the end of the run."""
        self._add(self._kept)
        self._kept = self._kept[:0]

    def _add(self, rows: Numbers) -> None:
        for observers in self._of_constraints.values():
            for observer in observers:
                observer.add(rows)
        if self._labels or self._ages:
            self._add_accesses(rows[self._of_values.places(rows)])

    def _add_accesses(self, rows: Numbers) -> None:
        readings: dict[str, list[Reading]] = {}
        for reading in self._values.readings(rows[:, Observation.TIME], rows[:, Observation.ROUTE]):
            readings.setdefault(reading.source.name, []).append(reading)
        for ages in self._ages.values():
            ages.add(readings.get(ages.constraint.label, ()))
        for label, found in readings.items():
            if label in self._labels:
                self._labels[label].add(found)

    def quantities(self, constraint: EventConstraint) -> list[LimitedQuantity]:
        """What was observed of a constraint; nothing if it limits nothing, or cannot be observed."""
        if (ages := self._ages.get(id(constraint))) is not None:
            return list(ages.quantities(self.end))
        observers = self._of_constraints.get(id(constraint), ())
        return [quantity for observer in observers for quantity in observer.metrics.quantities(self.end)]

    def reason(self, constraint: EventConstraint) -> str:
        """Why nothing was observed of a constraint."""
        return self._reasons.get(id(constraint), "it names no events" if limits_of(constraint) else NO_LIMIT)

    def labels(self) -> Iterator[LabelObservation]:
        """What was observed of the labels that were asked for."""
        return (ages.observation(self._values) for ages in self._labels.values())
