"""Simulations of files, one or many, and of systems."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.design.campaign.run import RunOutcome, plan_runs
from amalthea_uros.design.campaign.simulations import CampaignResult, SimulationJob, require_bounded_work
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.change import Change, Sweeps, as_sweeps
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.names import require
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.services.changed import ChangedSystem, open_changed
from amalthea_uros.services.subject import Subject
from amalthea_uros.simulate.options import ALL_LABELS, Options, SimulationMode
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.basics.stated_times import TimeLike

if TYPE_CHECKING:
    from amalthea_uros.analyze.impact import Impact
    from amalthea_uros.simulate.results import Simulation
    from amalthea_uros.simulate.runs.run import OpenSink


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
    changed = open_changed(paths, options.settings, changes, with_bus=with_bus)
    return simulate_changed(changed, options, trace_paths, with_metrics=with_metrics)


def simulate_changed(
    changed: ChangedSystem, options: Options, trace_paths: Iterable[StrPath] = (), *, with_metrics: bool = False
) -> SimulationResult:
    """Simulate what was opened, with its settings; parameters and errors as for `simulate_files`."""
    result = _simulated(changed, options, _writers(trace_paths))
    impact = None
    if changed.differences:
        from amalthea_uros.design.observed_figures import observed_impact
        from amalthea_uros.simulate.runs.run import simulate_system

        # Compared with a run without the changes and with the same seed, of which nothing is written.
        before = simulate_system(changed.given.system, replace(options, settings=changed.given.settings, traced=None))
        impact = observed_impact(before, result.simulation)
    return replace(result, with_metrics=with_metrics, impact=impact)


def simulate(
    subject: Subject,
    duration: TimeLike,
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
    duration : model time, such as "5 min" or a `Duration`
    mode : how values that vary are chosen: "sampled", "worst", "best" or "average"
    changes : such as "Executor_Task.period=2ms"
    trace : keep the events of the whole run in memory, about 50 bytes for each
    trace_paths : files for the events of the whole run; the suffix says which format
    labels : of which accesses and ages of values are observed; "all": of all

    Raises
    ------
    ReadError, WriteError, InvalidArgumentError : as for `simulate_files`.
    """
    from amalthea_uros.simulate.results import RunOrigin
    from amalthea_uros.trace.sinks import EventRecorder

    changed = open_changed(subject, settings, changes)
    recorder = EventRecorder()
    sinks: list[OpenSink] = [*_writers(trace_paths), *([recorder] if trace else [])]
    traced = (0, duration) if sinks else None
    if mode not in tuple(SimulationMode):
        raise InvalidArgumentError(f"unknown mode {mode!r}; expected one of {', '.join(SimulationMode)}")
    options = Options(duration=duration, seed=seed, mode=SimulationMode(mode), traced=traced, labels=labels)
    result = _simulated(changed, options, sinks)
    origin = RunOrigin(result.system, result.options)
    return replace(result.simulation, findings=result.findings, trace=recorder.table if trace else None, origin=origin)


def simulate_campaign(
    paths: StrPath | Iterable[StrPath],
    options: Options,
    *,
    changes: Sequence[Change] = (),
    sweeps: Sweeps = (),
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

    sweeps = as_sweeps(sweeps)
    runs = plan_runs(sweeps, repetitions, options.seed)
    changed = open_changed(paths, options.settings, changes, with_bus=with_bus)
    changed.check_sweeps(sweeps)
    _require_labels(options.labels, changed.system)
    require_bounded_work(changed.system, options, len(runs))
    job, executor = SimulationJob(changed.origin, changed.changes, options), executor_for(len(runs), workers, cluster)
    return CampaignResult(
        paths=changed.opened.paths,
        options=options,
        outcomes=finished_runs(job, runs, executor, on_outcome),
        planned=len(runs),
        findings=unsuppressed(changed.opened.findings),
        differences=changed.differences,
    )


def _writers(paths: Iterable[StrPath]) -> list[OpenSink]:
    from amalthea_uros.trace.sinks import open_sink

    return [partial(open_sink, Path(path)) for path in one_or_several(paths)]


def _simulated(changed: ChangedSystem, options: Options, sinks: Sequence[OpenSink]) -> SimulationResult:
    from amalthea_uros.simulate.runs.run import simulate_system

    _require_labels(options.labels, changed.system)
    options = replace(options, settings=changed.settings)
    simulation = simulate_system(changed.system, options, sinks)
    return SimulationResult(
        paths=changed.opened.paths,
        system=changed.system,
        options=options,
        simulation=simulation,
        findings=unsuppressed((*changed.opened.findings, *simulation.findings)),
        differences=changed.differences,
    )


def _require_labels(names: Iterable[str], system: System) -> None:
    """Refuse labels that a system does not have; raises as `require`."""
    require("label", (name for name in names if name != ALL_LABELS), system.labels)
