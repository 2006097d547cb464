"""Response times, loads, latencies and verdicts of files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.impact import Impact, impact
from amalthea_uros.analyze.response_times.kernel import report_machine_code
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.change import Change, Changes
from amalthea_uros.diagnostics import Finding
from amalthea_uros.names import require
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.services.analysis_findings import shown_findings
from amalthea_uros.services.changed import ChangedSystem, open_changed
from amalthea_uros.services.subject import Subject
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.priorities.assignment import Proposal
    from amalthea_uros.analyze.results.explanations import CallbackExplanation, ChainExplanation, ProcessExplanation
    from amalthea_uros.analyze.sensitivity import Sensitivity
    from amalthea_uros.design.improvements import Improvements
    from amalthea_uros.design.missing_values import MissingValues
    from amalthea_uros.services.first_answer import FirstAnswer


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Explanation(Shown):
    """What the response time of a process or callback, or a latency of a chain consists of; several of them if they have the name.

    Attributes
    ----------
    callbacks : for each process that calls the callback
    improvements : changes that shorten the latency of the chain
    """

    name: str
    process: ProcessExplanation | None
    chain: ChainExplanation | None
    callbacks: tuple[CallbackExplanation, ...] = ()
    improvements: Improvements | None = None

    def __repr__(self) -> str:
        return f"<Explanation of {self.name}>"


@dataclass(frozen=True, slots=True, kw_only=True)
class AnalysisResult(Brief, Shown):
    """The analysis of some files, with what it rests on.

    Attributes
    ----------
    task_periods : those that an app.yaml offers to tasks
    changed : what was analysed; None if only an analysis is known
    findings : problems found while reading the files, and what the analysis could not take into account
    sensitivity, proposals, explanation : None if they were not requested
    all_methods : whether the values of all methods are shown, or the tightest ones
    with_metrics : whether the metrics of all processes are shown
    differences : what changes did before the analysis
    impact : what they do to the results; None without changes
    answer : the one answer that text begins with; None if it is not wanted, or nothing was judged
    missing : what can be stated so that more processes have a response time; None if it is not wanted, or nothing helps
    """

    paths: tuple[Path, ...]
    task_periods: tuple[Time, ...] = ()
    changed: ChangedSystem | None = field(default=None, compare=False)
    system: System
    settings: Settings
    analysis: Analysis
    findings: tuple[Finding, ...]
    sensitivity: Sensitivity | None = None
    proposals: tuple[Proposal, ...] | None = None
    explanation: Explanation | None = None
    all_methods: bool = False
    with_metrics: bool = False
    differences: tuple[Difference, ...] = ()
    impact: Impact | None = None
    missing: MissingValues | None = None
    answer: FirstAnswer | None = field(default=None, compare=False)

    @classmethod
    def of(cls, changed: ChangedSystem, analysis: Analysis, paths: tuple[Path, ...] = ()) -> AnalysisResult:
        """The analysis of what was opened, with what it rests on."""
        return cls(
            paths=paths,
            task_periods=changed.opened.task_periods,
            changed=changed,
            system=changed.system,
            settings=changed.settings,
            analysis=analysis,
            findings=analysis.findings,
        )


@dataclass(frozen=True, slots=True)
class ChainDetail:
    """All values of a chain, by all methods or the tightest ones, and how its events are connected."""

    chain: ChainResult
    all_methods: bool


def analyze(subject: Subject, settings: Settings | None = None, *, changes: Changes = ()) -> Analysis:
    """Compute response times, loads, latencies of chains and verdicts of whatever describes a system.

    >>> analysis = analyze("app.yaml")              # doctest: +SKIP
    >>> analysis["Control_Function"].response.worst  # doctest: +SKIP

    Parameters
    ----------
    subject : the path of an `app.yaml` or of an AMALTHEA model, several paths of one model, the text of an `app.yaml` (with at least
        one line break), its content as a dict, a `Model`, or a `System`, such as `taskset` makes
    changes : such as `{"Executor_Task.period": "2 ms"}`, or texts as for `amuros analyze --set`

    Returns
    -------
    Analysis : its findings include those about the subject, such as references that lead nowhere.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong; carries a finding for each mistake.
    InvalidArgumentError : the settings or changes name something that does not exist, or have values that cannot be.
    TypeError : the subject is something else; the text lists what is accepted.
    """
    return _analyzed(open_changed(subject, settings, changes))


def analyze_files(
    paths: StrPath | Iterable[StrPath],
    settings: Settings | None = None,
    *,
    changes: Sequence[Change] = (),
    with_sensitivity: bool = False,
    with_priorities: bool = False,
    all_methods: bool = False,
    with_metrics: bool = False,
    with_bus: bool = False,
    with_missing: bool = False,
) -> AnalysisResult:
    """Analyze an `app.yaml` or AMALTHEA models.

    Parameters
    ----------
    changes : of the system and the settings, made before the analysis; the result has what they do to it
    with_sensitivity : also find out by how much execution times may grow
    with_priorities : also propose priorities that meet all deadlines
    all_methods : show the values of all methods for chains
    with_metrics : show the metrics of all processes
    with_bus : also analyze the messages on the CAN bus of an `app.yaml`
    with_missing : also find out what can be stated so that more processes have a response time

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : the changes or settings name what does not exist, or a phase in which no job is released; a value is wrong;
        there is no bus.
    """
    changed = open_changed(paths, settings, changes, with_bus=with_bus)
    before = analyze_system(*changed.given) if changed.changes else None
    analysis = _analyzed(changed)
    sensitivity, proposals = None, None
    if with_sensitivity:
        from amalthea_uros.analyze.sensitivity import sensitivity as sensitivity_of

        sensitivity = sensitivity_of(analysis)
    if with_priorities:
        from amalthea_uros.analyze.priorities.assignment import propose_priorities

        proposals = tuple(propose_priorities(analysis))
    missing = None
    if with_missing:
        from amalthea_uros.services.missing import missing_from

        missing = missing_from(changed, analysis)
    return replace(
        AnalysisResult.of(changed, analysis, changed.opened.paths),
        sensitivity=sensitivity,
        proposals=proposals,
        all_methods=all_methods,
        with_metrics=with_metrics,
        differences=changed.differences,
        impact=None if before is None else impact(before, analysis),
        missing=missing,
    )


def _analyzed(changed: ChangedSystem) -> Analysis:
    """The analysis, whose findings include those about the subject."""
    analysis = analyze_system(changed.system, changed.settings)
    report_machine_code()
    opened = changed.opened
    return replace(analysis, findings=shown_findings(opened.findings, opened.assembly, analysis))


#: What can be explained: an analysis, or what can be analyzed.
Analyzed: TypeAlias = "Analysis | AnalysisResult | Subject"


def analysis_result(analyzed: Analyzed) -> AnalysisResult:
    """The analysis with what it rests on; of something else than files, there are no paths."""
    if isinstance(analyzed, AnalysisResult):
        return analyzed
    if not isinstance(analyzed, Analysis):
        changed = open_changed(analyzed)
        return AnalysisResult.of(changed, _analyzed(changed))
    context = analyzed.solution.context
    return AnalysisResult(
        paths=(), system=context.system, settings=context.settings, analysis=analyzed, findings=analyzed.findings
    )


def chain_detail(result: AnalysisResult, chain: str) -> ChainDetail:
    """All values of a chain.

    Raises
    ------
    InvalidArgumentError : there is no such chain.
    """
    require("chain", [chain], result.system.chains)
    return ChainDetail(result.analysis.chains[chain], result.all_methods)
