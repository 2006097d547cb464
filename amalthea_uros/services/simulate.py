"""Simulations of files, one or many, and of systems."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from operator import index
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.shown import Shown
from amalthea_uros.design.campaign.run import CampaignRun, Record, RunOutcome, plan_runs, system_bytes, system_from
from amalthea_uros.design.changes.apply import Difference, apply
from amalthea_uros.design.changes.change import Change, Sweep, parse_change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.timing_changes import described
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import as_paths, open_system
from amalthea_uros.services.names import require_labels, require_settings
from amalthea_uros.services.subject import Subject, open_subject
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time, parse_time

if TYPE_CHECKING:
    from amalthea_uros.analyze.impact import Impact
    from amalthea_uros.simulate.results import Simulation
    from amalthea_uros.trace.sinks import TraceSink
    from amalthea_uros.trace.table import Entity

    #: Opens what events are written to, when the entities of the trace are known.
    OpenSink: TypeAlias = Callable[[Sequence[Entity]], TraceSink]

#: What can be observed of a limit in a run.
KEPT, MISSED, NOT_OBSERVED = ObservedVerdict.OK, ObservedVerdict.MISSED, ObservedVerdict.NOT_OBSERVED
#: The end of the columns with verdicts in a row of a table.
_VERDICT = ".verdict"
#: The column with what was not simulated.
_ERRORS = "errors"


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationPlan:
    """What is to be simulated.

    Attributes
    ----------
    system : with the changes
    options : with the changes of settings
    differences : what the changes did
    findings : problems found while reading the files
    given : the system and the settings without the changes
    """

    paths: tuple[Path, ...]
    system: System
    options: Options
    differences: tuple[Difference, ...]
    findings: tuple[Finding, ...]
    given: Configuration


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationResult(Brief, Shown):
    """The simulation of some files, with what it rests on.

    Attributes
    ----------
    system : with the changes
    options : with the changes of settings
    differences : what the changes did
    findings : problems found while reading the files, and what the simulation does not take into account
    with_metrics : whether the metrics of all processes are shown
    impact : what the changes do to what is observed with the same seed; None without changes
    """

    paths: tuple[Path, ...]
    system: System
    options: Options
    simulation: Simulation
    findings: tuple[Finding, ...]
    differences: tuple[Difference, ...] = ()
    with_metrics: bool = False
    impact: Impact | None = None

    @property
    def is_failed(self) -> bool:
        """Whether a limit was observed as missed, an activation was lost, or not everything was simulated."""
        return bool(self.simulation.missed or self.simulation.errors)


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignResult(Brief, Shown):
    """Many simulations of some files.

    Attributes
    ----------
    outcomes : in the order of the runs; those that were not finished when somebody interrupted are absent
    planned : number of runs
    differences : what the changes of all runs did
    findings : problems found while reading the files
    """

    paths: tuple[Path, ...]
    options: Options
    outcomes: tuple[RunOutcome, ...]
    planned: int
    findings: tuple[Finding, ...]
    differences: tuple[Difference, ...] = ()

    @property
    def rows(self) -> list[Record]:
        """The rows of a table of all runs."""
        return [outcome.row() for outcome in self.outcomes]

    @property
    def is_failed(self) -> bool:
        """Whether a run failed, or in one a limit was missed, an activation was lost, or not everything was simulated."""
        return bool(self.failed or self.missed or self.incomplete)

    @property
    def is_complete(self) -> bool:
        """Whether all runs were executed."""
        return len(self.outcomes) == self.planned

    @property
    def failed(self) -> tuple[RunOutcome, ...]:
        """The runs that could not be executed."""
        return tuple(outcome for outcome in self.outcomes if outcome.error)

    @property
    def incomplete(self) -> tuple[RunOutcome, ...]:
        """The runs in which not everything was simulated."""
        return tuple(outcome for outcome in self.outcomes if outcome.record.get(_ERRORS))

    @property
    def missed(self) -> tuple[RunOutcome, ...]:
        """The runs in which a limit was observed as missed, or an activation was lost."""
        return tuple(outcome for outcome in self.outcomes if judged_in(outcome.record, MISSED))

    @property
    def not_observed(self) -> tuple[RunOutcome, ...]:
        """The runs in which a limit was neither observed as kept nor as missed."""
        return tuple(outcome for outcome in self.outcomes if judged_in(outcome.record, NOT_OBSERVED))

    @property
    def is_anything_kept(self) -> bool:
        """Whether a limit was observed as kept in a run."""
        return any(judged_in(outcome.record, KEPT) for outcome in self.outcomes)


def judged_in(record: Record, verdict: ObservedVerdict) -> list[str]:
    """What has a verdict in a run, by the columns with verdicts; lost activations are one that was missed."""
    return [name.removesuffix(_VERDICT) for name, value in record.items() if name.endswith(_VERDICT) and value == verdict]


@dataclass(frozen=True, slots=True)
class SimulationJob:
    """Simulates a system with the changes and the seed of a run."""

    system: System
    options: Options
    changes: tuple[Change, ...] = ()

    def __call__(self, run: CampaignRun) -> Record:
        """The observations of a run as a row of a table."""
        changed = apply(self.system, self.options.settings, (*self.changes, *run.changes))
        return _simulated(changed.system, replace(self.options, settings=changed.settings, seed=run.seed)).record()

    def __reduce__(self) -> tuple[object, ...]:
        return _received_job, (system_bytes(self.system), self.options, self.changes)


def _received_job(system: bytes, options: Options, changes: tuple[Change, ...]) -> SimulationJob:
    return SimulationJob(system_from(system), options, changes)


def plan_simulation(
    paths: StrPath | Iterable[StrPath], options: Options, changes: Sequence[Change] = (), *, with_bus: bool = False
) -> SimulationPlan:
    """Read what is to be simulated, and change it.

    Parameters
    ----------
    with_bus : also simulate the messages on the CAN bus of an `app.yaml`

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : the changes or settings name what does not exist, or are wrong; there is no bus.
    """
    files = as_paths(paths)
    opened = open_system(files, with_bus=with_bus)
    given = Configuration(opened.system, options.settings)
    differences = described(given, changes)
    system, settings = apply(*given, changes)
    require_settings(settings, system)
    require_labels(options.labels, system)
    return SimulationPlan(
        paths=files,
        system=system,
        options=replace(options, settings=settings),
        differences=differences,
        findings=opened.findings,
        given=given,
    )


def simulate_plan(plan: SimulationPlan, trace_paths: Iterable[StrPath] = (), *, with_metrics: bool = False) -> SimulationResult:
    """Simulate what was planned; parameters and errors as for `simulate_files`."""
    simulation = _simulated(plan.system, plan.options, [*map(_trace_opener, trace_paths)])
    return SimulationResult(
        paths=plan.paths,
        system=plan.system,
        options=plan.options,
        simulation=simulation,
        findings=unsuppressed((*plan.findings, *simulation.findings)),
        differences=plan.differences,
        with_metrics=with_metrics,
        impact=_impact(plan, simulation) if plan.differences else None,
    )


def _impact(plan: SimulationPlan, simulation: Simulation) -> Impact:
    """What the changes do: compared with a run without them and with the same seed, of which nothing is written."""
    from amalthea_uros.design.observed_figures import observed_impact

    before = _simulated(plan.given.system, replace(plan.options, settings=plan.given.settings, traced=None))
    return observed_impact(before, simulation)


def simulate_files(
    paths: StrPath | Iterable[StrPath],
    options: Options,
    *,
    changes: Sequence[Change] = (),
    trace_paths: Iterable[StrPath] = (),
    with_metrics: bool = False,
    with_bus: bool = False,
) -> SimulationResult:
    """Simulate an `app.yaml` or AMALTHEA models.

    Parameters
    ----------
    changes : of the system and the settings, made before the run
    trace_paths : files for the events; the suffix says which format
    with_metrics : show the metrics of all processes
    with_bus : also simulate the messages on the CAN bus of an `app.yaml`

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    WriteError : a trace cannot be written.
    InvalidArgumentError : the changes or settings name what does not exist or are wrong, or the format of a trace is not known.
    """
    plan = plan_simulation(paths, options, changes, with_bus=with_bus)
    return simulate_plan(plan, trace_paths, with_metrics=with_metrics)


def simulate(
    subject: Subject,
    duration: str | Time,
    *,
    seed: int = 1,
    mode: SimulationMode | str = SimulationMode.SAMPLED,
    settings: Settings | None = None,
    changes: Iterable[str | Change] = (),
    trace: bool = False,
    trace_paths: Iterable[StrPath] = (),
    labels: Iterable[str] = (),
) -> Simulation:
    """Simulate whatever describes a system: files, a description as text or dict, an AMALTHEA model, or a system.

    >>> simulation = simulate("app.yaml", "100 ms", trace=True)  # doctest: +SKIP
    >>> simulation.trace.to_dataframe()                                # doctest: +SKIP

    Parameters
    ----------
    subject : as for `analyze`
    duration : model time, such as "5 min", or picoseconds
    mode : how values that vary are chosen: "sampled", "worst", "best" or "average"
    changes : such as "Executor_Task.period=2ms"
    trace : keep the events of the whole run in memory, about 50 bytes for each
    trace_paths : files for the events of the whole run; the suffix says which format
    labels : of which accesses and ages of values are observed; "all": of all

    Raises
    ------
    ReadError, WriteError, InvalidArgumentError : as for `simulate_files`.
    """
    opened = open_subject(subject)
    parsed = [change if isinstance(change, Change) else parse_change(change) for change in changes]
    system, settings = apply(opened.system, settings or Settings(), parsed)
    require_settings(settings, system)
    from amalthea_uros.trace.sinks import EventRecorder

    observed = tuple(labels)
    require_labels(observed, system)
    time, recorder = time_of(duration), EventRecorder()
    sinks: list[OpenSink] = [*map(_trace_opener, trace_paths), *([recorder] if trace else [])]
    traced = (0, time) if sinks else None
    options = Options(duration=time, seed=seed, mode=_mode(mode), settings=settings, traced=traced, labels=observed)
    simulation = _simulated(system, options, sinks)
    findings = unsuppressed((*opened.findings, *simulation.findings))
    return replace(simulation, findings=findings, trace=recorder.table if trace else None)


def simulate_campaign(
    paths: StrPath | Iterable[StrPath],
    options: Options,
    *,
    changes: Sequence[Change] = (),
    sweeps: Sequence[Sweep] = (),
    repetitions: int = 1,
    with_bus: bool = False,
    workers: int | None = None,
    cluster: str | None = None,
    on_outcome: Callable[[RunOutcome], None] | None = None,
) -> CampaignResult:
    """Simulate each variant of some files, several times with different seeds.

    Ctrl-C ends the campaign early; the result has the runs that were finished.

    Parameters
    ----------
    options : the seed is that of the first repetition
    repetitions : runs of each variant
    with_bus : also simulate the messages on the CAN bus of an `app.yaml`
    workers : runs at the same time on this computer; None: as many as there are cores
    cluster : address of a Dask scheduler, on whose workers the runs are executed instead
    on_outcome : called after each run

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : as for `simulate_files`; there are too many runs, or the cluster cannot be used.
    """
    from amalthea_uros.design.campaign.campaign import finished_runs
    from amalthea_uros.design.campaign.executors import executor_for

    files = as_paths(paths)
    runs = plan_runs(sweeps, repetitions, options.seed)
    opened = open_system(files, with_bus=with_bus)
    differences = described(Configuration(opened.system, options.settings), changes)
    _check_changes(opened.system, options, changes, sweeps)
    job, executor = SimulationJob(opened.system, options, tuple(changes)), executor_for(len(runs), workers, cluster)
    return CampaignResult(
        paths=files,
        options=options,
        outcomes=finished_runs(job, runs, executor, on_outcome),
        planned=len(runs),
        findings=unsuppressed(opened.findings),
        differences=differences,
    )


def _simulated(system: System, options: Options, sinks: Sequence[OpenSink] = ()) -> Simulation:
    from amalthea_uros.simulate.runs.run import simulate_system

    return simulate_system(system, options, sinks)


def _trace_opener(path: StrPath) -> OpenSink:
    from amalthea_uros.trace.sinks import open_sink

    return partial(open_sink, Path(path))


def _check_changes(system: System, options: Options, changes: Sequence[Change], sweeps: Sequence[Sweep]) -> None:
    """Refuse wrong names and values before the first run; of long sweeps the ends are tried."""
    for values in ([], *([change] for sweep in sweeps for change in _ends(sweep))):
        changed = apply(system, options.settings, (*changes, *values))
        require_settings(changed.settings, changed.system)
        require_labels(options.labels, changed.system)


def _ends(sweep: Sweep) -> list[Change]:
    changes = list(sweep.changes())
    return [changes[0], changes[-1]]


def time_of(duration: str | Time) -> Time:
    """A duration in picoseconds; InvalidArgumentError if it is no time."""
    try:
        return parse_time(duration) if isinstance(duration, str) else index(duration)
    except TypeError:
        message = f"the duration must be a time such as '1 s', or whole picoseconds, not {duration!r}"
        raise InvalidArgumentError(message) from None
    except ValueError as error:
        raise InvalidArgumentError(f"the duration {error}") from None


def _mode(mode: SimulationMode | str) -> SimulationMode:
    if mode not in tuple(SimulationMode):
        raise InvalidArgumentError(f"unknown mode {mode!r}; expected one of {', '.join(SimulationMode)}")
    return SimulationMode(mode)
