"""Everything that a report of a system shows, computed once: data only."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.files import STANDARD_INPUT
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.change import Changes
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.perf.activities import Call, walk
from amalthea_uros.perf.system import System
from amalthea_uros.services.analyze import AnalysisResult
from amalthea_uros.services.changed import open_changed
from amalthea_uros.services.check import check_input
from amalthea_uros.services.first_answer import FirstAnswer, first_answer
from amalthea_uros.services.inputs import ModelInput
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.services.subject import Subject, SystemInput
from amalthea_uros.services.waiting_messages import findings_of, with_analysed_storage
from amalthea_uros.simulate.options import Options
from amalthea_uros.timing.activation.load import activation_rates
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND, MILLISECOND, NANOSECOND, SECOND, Duration, Time

if TYPE_CHECKING:
    from amalthea_uros.findings.presentation import Presentation
    from amalthea_uros.uros.assemble import Assembly

#: How long a run may be if nobody says it, the longest first.
_DURATIONS = (
    10 * SECOND,
    5 * SECOND,
    2 * SECOND,
    SECOND,
    *(part * unit for unit in (MILLISECOND, MICROSECOND, NANOSECOND) for part in (500, 200, 100, 50, 20, 10, 5, 2, 1)),
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
    system : with the changes
    before : the analysis without the changes; None if there are none
    differences : what the changes did
    simulation : None if it was not wanted; its options say the duration
    is_duration_chosen : whether the duration was chosen to bound the work
    check : the findings of the rules; None if there is no model, but only a system
    findings : of reading, analysis and simulation, without those of the rules
    answer : what the verdict depends on, and what would help; None if nothing was judged
    assembly : what an `app.yaml` says beyond the system: messages, pools
    """

    title: str
    date: str = ""
    system: System
    analysis: Analysis
    before: Analysis | None = None
    differences: tuple[Difference, ...] = ()
    simulation: SimulationResult | None = None
    is_duration_chosen: bool = False
    check: Presentation | None = None
    findings: tuple[Finding, ...] = ()
    answer: FirstAnswer | None = None
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
    changed = open_changed(subject, settings, changes, with_bus=with_bus)
    opened, system = changed.opened, changed.system
    analysis = analyze_system(system, changed.settings)
    before = analyze_system(*changed.given) if changed.changes else None
    model = _model_of(opened)
    simulation = None
    if with_simulation:
        options = Options(duration=Duration(duration or default_duration(analysis)), seed=seed, settings=changed.settings)
        simulation = _simulated(system, options, is_kept=duration is None)
    # Those of reading and building a model are among the findings of the check.
    told = () if model is None else model.findings
    findings = [finding for finding in opened.findings if finding not in told]
    findings += (
        *findings_of(opened.assembly, analysis),
        *(() if simulation is None else simulation.findings),
    )
    return ReportContent(
        title=title or _name(opened),
        date=date,
        system=system,
        analysis=analysis,
        before=before,
        differences=tuple(each for each in changed.differences if not each.is_consequence),
        simulation=simulation,
        is_duration_chosen=duration is None,
        check=None if model is None else check_input(model, next(iter(_files(opened)), Path())),
        findings=tuple(dict.fromkeys(unsuppressed(findings))),
        answer=first_answer(AnalysisResult.of(changed, analysis)),
        assembly=None if opened.assembly is None else with_analysed_storage(opened.assembly, before or analysis),
    )


def _model_of(opened: SystemInput) -> ModelInput | None:
    """The AMALTHEA model that is checked; None for a system, of which there is none."""
    if opened.assembly is not None:
        from amalthea_uros.bridge.build import build_model

        system = opened.assembly.system
        return ModelInput(model=build_model(system), findings=opened.assembly.findings, system=system)
    if opened.model is None:
        return None
    return ModelInput(model=opened.model, findings=opened.model.findings, system=opened.system)


def _files(opened: SystemInput) -> tuple[Path, ...]:
    documents = () if opened.model is None else opened.model.documents
    return opened.paths or tuple(document.path for document in documents if document.path is not None)


def _name(opened: SystemInput) -> str:
    names = ["standard input" if path == STANDARD_INPUT else path.name or str(path) for path in _files(opened)]
    if not names and opened.assembly is not None:
        return opened.assembly.description.name
    return ", ".join(names) or ("System" if opened.model is None else "Model")


def _simulated(system: System, options: Options, *, is_kept: bool) -> SimulationResult:
    """A run; if the events are kept, which takes memory, pictures need not repeat it."""
    from amalthea_uros.simulate.runs.run import simulate_system
    from amalthea_uros.trace.sinks import EventRecorder

    recorder = EventRecorder()
    traced = (0, options.duration) if is_kept else None
    simulation = simulate_system(system, replace(options, traced=traced), [recorder] if is_kept else [])
    return SimulationResult(
        paths=(),
        system=system,
        options=options,
        simulation=replace(simulation, trace=recorder.table if is_kept else None),
        findings=unsuppressed(simulation.findings),
    )


def default_duration(analysis: Analysis) -> Time:
    """The longest of some round durations, up to 10 s, in which not too many jobs and calls of runnables are executed."""
    context = analysis.solution.context
    rates = activation_rates(context.system, context.activations)
    work = sum((rate * (1 + _calls(context.system, name)) for name, rate in rates.items()), Fraction(0))
    return next((duration for duration in _DURATIONS if duration * work <= _MOST_WORK), _DURATIONS[-1])


def _calls(system: System, process: str) -> int:
    return sum(isinstance(activity, Call) for activity in walk(system.processes[process].activities))
