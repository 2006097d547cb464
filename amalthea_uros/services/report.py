"""Everything that a report of a system shows, computed once: data only."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.files import STANDARD_INPUT
from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import Difference, apply, describe
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.perf.activities import Call, walk
from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import ModelInput, as_paths, refuse_descriptions
from amalthea_uros.services.names import require_settings
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.services.subject import Subject
from amalthea_uros.services.waiting_messages import with_analysed_storage
from amalthea_uros.services.what_if import Changes, as_changes
from amalthea_uros.simulate.options import Options
from amalthea_uros.timing.activation.load import activation_rates
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MILLISECOND, SECOND, Time

if TYPE_CHECKING:
    from amalthea_uros.findings.presentation import Presentation
    from amalthea_uros.metamodel.model import Model
    from amalthea_uros.uros.assemble import Assembly

#: How long a run may be if nobody says it, the longest first.
_DURATIONS = (
    10 * SECOND,
    5 * SECOND,
    2 * SECOND,
    SECOND,
    *(part * MILLISECOND for part in (500, 200, 100, 50, 20, 10, 5, 2, 1)),
)
#: About so many jobs and calls of runnables are executed in such a run: a second on a usual computer.
_MOST_WORK = 20_000


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportContent:
    """What a report shows.

    Attributes
    ----------
    title : by default, the names of the files
    date : as the caller states it; "" for none, so that the same input gives the same report
    system, settings : with the changes
    before : the analysis without the changes; None if there are none
    differences : what the changes did
    simulation : None if it was not wanted; its options say the duration
    is_duration_chosen : whether the duration was chosen to bound the work
    check : the findings of the rules; None if there is no model, but only a system
    findings : of reading, analysis and simulation, without those of the rules
    assembly : what an `app.yaml` says beyond the system: messages, pools
    """

    title: str
    date: str = ""
    system: System
    settings: Settings
    analysis: Analysis
    before: Analysis | None = None
    differences: tuple[Difference, ...] = ()
    simulation: SimulationResult | None = None
    is_duration_chosen: bool = False
    check: Presentation | None = None
    findings: tuple[Finding, ...] = ()
    assembly: Assembly | None = None

    @property
    def warnings(self) -> tuple[Finding, ...]:
        """The findings that the verdict is subject to: it may not be that of the real system."""
        return tuple(each for each in self.findings if each.severity is not Severity.INFO)


def compile_report(
    subject: Subject,
    settings: Settings | None = None,
    *,
    changes: Changes = (),
    with_bus: bool = False,
    with_simulation: bool = True,
    duration: Time | None = None,
    seed: int = 1,
    title: str | None = None,
    date: str = "",
) -> ReportContent:
    """Analyze, simulate and check files, an AMALTHEA model or a system, for a report.

    Parameters
    ----------
    changes : such as `{"Executor_Task.period": "2 ms"}`, or texts as for `amuros report --set`; made before everything but the check
        of the files
    with_bus : with the messages on the CAN bus of an `app.yaml`
    duration : of the simulation; None: so long that about twenty thousand jobs and calls are executed, but at most 10 s
    title : None: the names of the files
    date : shown below the title

    Raises
    ------
    ReadError : a file cannot be read, or something in a description or in the settings of the project is wrong.
    InvalidArgumentError : changes or settings name what does not exist, or are wrong; there is no bus.
    """
    opened = _open(subject, with_bus)
    parsed = as_changes(changes)
    unchanged = settings or Settings()
    require_settings(unchanged, opened.system)
    differences = describe(opened.system, unchanged, parsed)
    system, used = apply(opened.system, unchanged, parsed)
    analysis = analyze_system(system, used)
    before = analyze_system(opened.system, unchanged) if parsed else None
    assembly = opened.assembly
    simulation = None
    if with_simulation:
        options = Options(duration=duration or default_duration(analysis), seed=seed, settings=used)
        simulation = _simulated(system, options, is_kept=duration is None)
    return ReportContent(
        title=title or opened.name,
        date=date,
        system=system,
        settings=used,
        analysis=analysis,
        before=before,
        differences=differences,
        simulation=simulation,
        is_duration_chosen=duration is None,
        check=_checked(opened),
        findings=_findings(opened, analysis, simulation),
        assembly=None if assembly is None else with_analysed_storage(assembly, before or analysis),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Opened:
    """What a report is about.

    Attributes
    ----------
    model : None for a system
    folder : where the settings of the project are looked for
    findings : what could not be extracted
    """

    name: str
    system: System
    model: ModelInput | None = None
    folder: Path = field(default_factory=Path)
    findings: tuple[Finding, ...] = ()
    assembly: Assembly | None = None


def _open(subject: Subject, with_bus: bool) -> _Opened:
    from amalthea_uros.metamodel.model import Model

    if isinstance(subject, System | Model):
        if with_bus:
            raise InvalidArgumentError("only an app.yaml describes the messages on a CAN bus")
        return _Opened(name="System", system=subject) if isinstance(subject, System) else _of_model(subject, ())
    paths = as_paths(subject)
    if len(paths) == 1 and is_description(paths[0]):
        return _of_description(paths[0], with_bus)
    refuse_descriptions(paths)
    if with_bus:
        raise InvalidArgumentError("only an app.yaml describes the messages on a CAN bus; AMALTHEA models do not")
    from amalthea_uros.xmi.load import load

    return _of_model(load(*paths), paths)


def _of_description(path: Path, with_bus: bool) -> _Opened:
    from amalthea_uros.services.build import build

    built = build(path)
    assembly = built.assembly
    system = assembly.system_with_bus() if with_bus else assembly.system
    if system is None:
        raise InvalidArgumentError(f"no CAN bus is described in {path}; set 'middleware.transport.can.bitrate'")
    model = ModelInput(model=built.model, findings=assembly.findings, system=assembly.system)
    return _Opened(name=_name([path]), system=system, model=model, folder=path, assembly=assembly)


def _of_model(model: Model, paths: Sequence[Path]) -> _Opened:
    from amalthea_uros.bridge.extract import extract

    extraction = extract(model)
    named = paths or [document.path for document in model.documents if document.path is not None]
    return _Opened(
        name=_name(named) or "Model",
        system=extraction.system,
        model=ModelInput(model=model, findings=model.findings, system=extraction.system),
        folder=named[0] if named else Path(),
        findings=extraction.findings,
    )


def _name(paths: Iterable[Path]) -> str:
    return ", ".join("standard input" if path == STANDARD_INPUT else path.name or str(path) for path in paths)


def _simulated(system: System, options: Options, *, is_kept: bool) -> SimulationResult:
    """A run; if the events are kept, which takes memory, pictures need not repeat it."""
    from amalthea_uros.simulate.runs.run import simulate_system
    from amalthea_uros.trace.sinks import EventRecorder

    recorder = EventRecorder()
    if is_kept:
        simulation = simulate_system(system, replace(options, traced=(0, options.duration)), [recorder])
        simulation = replace(simulation, trace=recorder.table)
    else:
        simulation = simulate_system(system, options)
    findings = unsuppressed(simulation.findings)
    return SimulationResult(paths=(), system=system, options=options, simulation=simulation, findings=findings)


def _checked(opened: _Opened) -> Presentation | None:
    from amalthea_uros.services.check import check_input

    return None if opened.model is None else check_input(opened.model, opened.folder)


def _findings(opened: _Opened, analysis: Analysis, simulation: SimulationResult | None) -> tuple[Finding, ...]:
    """Each once, without those that comments accept."""
    simulated = simulation.findings if simulation is not None else ()
    return tuple(dict.fromkeys(unsuppressed((*opened.findings, *analysis.findings, *simulated))))


def default_duration(analysis: Analysis) -> Time:
    """The longest of some round durations, up to 10 s, in which not too many jobs and calls of runnables are executed."""
    context = analysis.solution.context
    rates = activation_rates(context.system, context.activations)
    work = sum((rate * (1 + _calls(context.system, name)) for name, rate in rates.items()), Fraction(0))
    return next((duration for duration in _DURATIONS if duration * work <= _MOST_WORK), _DURATIONS[-1])


def _calls(system: System, process: str) -> int:
    return sum(isinstance(activity, Call) for activity in walk(system.processes[process].activities))


def save_text(path: StrPath, text: str) -> None:
    """Write a file whole or not at all.

    Raises
    ------
    WriteError : the file cannot be written.
    """
    from amalthea_uros.xmi.emf.files import FileText, write_text

    write_text(Path(path), FileText(text))
