"""The result of a simulation run: what was observed in it; none of it is a bound of what can occur."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Record, Shown
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.judge.margins import tightest
from amalthea_uros.judge.verdict import WORST_OBSERVED_FIRST, ObservedVerdict
from amalthea_uros.simulate.observations import (
    ChainObservation,
    CoreObservation,
    ExecutorObservation,
    LabelObservation,
    LossObservation,
    MetricObservation,
    ProcessObservation,
    RequirementObservation,
    RunnableObservation,
)
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.units import Time, time_text

if TYPE_CHECKING:
    from amalthea_uros.perf.system import System
    from amalthea_uros.trace.table import EventTable

#: A cell of a table of runs.
Cell: TypeAlias = int | float | str | None


Judged: TypeAlias = ProcessObservation | RequirementObservation
#: The error of a run in which no process executed anything.
IDLE = "nothing was executed"


@dataclass(frozen=True, slots=True)
class RunOrigin:
    """What was simulated, and how."""

    system: System
    options: Options


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Simulation(Shown):
    """What was observed in a run.

    Attributes
    ----------
    duration : model time
    left_out : the processes that are not simulated, each with the reason
    executors : those that loop
    host : the executors of the host, if it is simulated
    losses : the messages on wires of which it is stated how many they lose
    runnables : those that requirements limit
    labels : those that were asked for
    assumptions : on which the run is based
    findings : what the simulation does not take into account
    trace : the events, if they were wanted
    origin : what pictures need to repeat a part of the run; kept by `amuros.simulate`
    """

    duration: Time
    seed: int
    mode: SimulationMode
    cores: Results[CoreObservation]
    processes: Results[ProcessObservation]
    left_out: Results[ProcessObservation] = field(default_factory=Results)
    chains: Results[ChainObservation] = field(default_factory=Results)
    executors: Results[ExecutorObservation] = field(default_factory=Results)
    host: Results[ExecutorObservation] = field(default_factory=Results)
    losses: Results[LossObservation] = field(default_factory=Results)
    runnables: Results[RunnableObservation] = field(default_factory=Results)
    labels: Results[LabelObservation] = field(default_factory=Results)
    requirements: Results[RequirementObservation] = field(default_factory=Results)
    assumptions: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    trace: EventTable | None = field(default=None, compare=False)
    origin: RunOrigin | None = field(default=None, compare=False)

    def __getitem__(self, process: str) -> ProcessObservation:
        """The observations of a process by its name.

        Raises
        ------
        KeyError : there is no such process; the text lists similar names.
        """
        return self.processes[process]

    def __repr__(self) -> str:
        jobs = sum(process.jobs for process in self.processes)
        return (
            f"<Simulation of {time_text(self.duration)}, {self.mode}, seed {self.seed}: {jobs} jobs, {len(self.missed)} missed>"
        )

    @property
    def lost_activations(self) -> int:
        """The number of lost activations of all processes."""
        return sum(process.lost_activations for process in self.processes)

    @property
    def errors(self) -> tuple[str, ...]:
        """What makes the observations incomplete: processes that were left out, a run that ended early or in which nothing happened."""
        found = tuple(finding.message for finding in self.findings if finding.severity is Severity.ERROR)
        is_idle = not any(process.jobs or process.unfinished for process in self.processes)
        is_idle = is_idle and not any(executor.iterations for executor in self.host)
        return (IDLE, *found) if is_idle else found

    @property
    def incomplete(self) -> str:
        """The first of the errors, and the number of the others; whether nothing at all was executed."""
        idle, errors = [each for each in self.errors if each == IDLE], [each for each in self.errors if each != IDLE]
        others = [counted(len(errors) - 1, "other error")] if errors[1:] else []
        return "; ".join([": ".join([*idle, *errors[:1]]), *others])

    @property
    def judged(self) -> tuple[Judged, ...]:
        """The processes, requirements and constraints with a verdict."""
        processes = (each for each in (*self.processes, *self.left_out) if each.verdict is not None)
        return (*processes, *self.requirements)

    @property
    def missed(self) -> tuple[Judged, ...]:
        """The processes, requirements and constraints that are observed as missed."""
        return tuple(item for item in self.judged if item.verdict is ObservedVerdict.MISSED)

    @property
    def not_observed(self) -> tuple[Judged, ...]:
        """Those on which nothing was observed that allows a verdict."""
        return tuple(item for item in self.judged if item.verdict is ObservedVerdict.NOT_OBSERVED)

    @property
    def tightest(self) -> Judged | None:
        """The process, requirement or constraint on a time that was kept with the smallest share of its limit left."""
        return tightest(item for item in self.judged if item.verdict is ObservedVerdict.OK and item.is_time)

    def record(self) -> dict[str, Cell]:
        """The values as one row of a table, such as `Task_5ms.response_time.max_ps`; times in whole picoseconds."""
        return dict(self._cells())

    def to_records(self, *, full: bool = False) -> list[Record]:
        """The metrics of all processes and the latencies of all chains, in a row each; times are picoseconds in columns `..._ps`."""
        return [
            {"object": name, "quantity": quantity, "count": found.count, **_times(found)}
            for name, quantity, found in self._observations()
        ]

    def _observations(self) -> Iterator[tuple[str, str, MetricObservation]]:
        # Of equal names, that of a process counts in a row of a table: the last one.
        items: list[tuple[str, Mapping[Any, MetricObservation]]] = []
        items += [(each.name, {"age": each.age}) for each in self.labels if each.age is not None]
        items += [(each.name, each.metrics) for each in self.runnables]
        items += [(each.name, each.metrics) for each in self.processes]
        items += [(each.name, each.quantities) for each in self.chains]
        yield from ((name, str(quantity), found) for name, values in items for quantity, found in values.items())

    def _cells(self) -> Iterator[tuple[str, Cell]]:
        yield from (("duration_ps", self.duration), ("seed", self.seed), ("mode", str(self.mode)))
        for core in self.cores:
            yield f"{core.name}.core_load", float(core.load)
        for process in self.processes:
            yield f"{process.name}.jobs", process.jobs
            yield f"{process.name}.load", float(process.load)
            yield f"{process.name}.lost_activations", process.lost_activations
            yield f"{process.name}.verdict", process.verdict
        yield from ((f"{process.name}.verdict", process.verdict) for process in self.left_out)
        for label in self.labels:
            yield f"{label.name}.reads", label.reads
            yield f"{label.name}.writes", label.writes
            yield f"{label.name}.unwritten_reads", label.unwritten_reads
            yield f"{label.name}.overwritten", label.overwritten
        for name, quantity, found in self._observations():
            yield from ((f"{name}.{quantity}.{column}", value) for column, value in _times(found).items())
        # Of several limits with one name, the worst verdict counts: the last cell.
        for requirement in sorted(self.requirements, key=lambda each: -WORST_OBSERVED_FIRST.index(each.verdict)):
            yield f"{requirement.name}.{requirement.quantity.replace(' ', '_')}.verdict", requirement.verdict
        yield "lost_activations", self.lost_activations
        if self.errors:
            yield "errors", self.incomplete


_COLUMNS = ("min_ps", "avg_ps", "max_ps", "std_ps")


def _times(found: MetricObservation) -> dict[str, int | float]:
    return dict(zip(_COLUMNS, (round(found.min), round(found.mean), round(found.max), found.std), strict=True))
