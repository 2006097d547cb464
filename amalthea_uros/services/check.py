"""Models and descriptions checked by rules."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path

from amalthea_uros._internal.files import reading_once
from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.paths import StrPath, by_model, without_other_yaml
from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.diagnostics import Finding, Severity, by_place
from amalthea_uros.errors import ReadError
from amalthea_uros.findings.accepted import baseline_text, is_suppressed
from amalthea_uros.findings.catalogue import is_unreadable
from amalthea_uros.findings.grouping import FindingGroup
from amalthea_uros.findings.presentation import Presentation, present
from amalthea_uros.findings.targets import TargetTool
from amalthea_uros.metamodel.model import Model
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.services.files import save_text
from amalthea_uros.services.inputs import ModelInput, as_paths, open_model
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import run, run_system
from amalthea_uros.validate.rule import ModelCheck, RuleProfile, SystemCheck
from amalthea_uros.validate.selection import Selection, select, unknown_rule
from amalthea_uros.validate.settings import CheckSettings, project_settings
from amalthea_uros.validate.shown_findings import accepted_by, not_suppressed, presented
from amalthea_uros.validate.user_rules import rules_of_file


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckResult(Brief, Shown):
    """The findings about some files that are not suppressed, by file and line.

    Attributes
    ----------
    findings : all of them, also those that report the same flaw, and those about target tools that nobody asked for
    presentation : the same as they are shown: one for each flaw, and one line about each of these tools
    fail_on : minimum severity at which the check fails
    is_readable : whether every file could be checked
    with_details : whether files for programs and baselines have all findings, and not one for each flaw
    rules : ids of the rules that were checked, none if no file could be
    """

    paths: tuple[Path, ...]
    findings: tuple[Finding, ...]
    presentation: Presentation
    fail_on: Severity
    is_readable: bool
    rules: tuple[str, ...]
    with_details: bool = False

    @property
    def fails(self) -> bool:
        """Whether a flaw is at least as severe as `fail_on`."""
        failing = tuple(Severity)[: tuple(Severity).index(self.fail_on) + 1]
        return any(finding.severity in failing for finding in self.presentation.shown)


@dataclass(frozen=True, slots=True)
class CheckStatistics:
    """How often each rule fires."""

    result: CheckResult


def check(model: Model, rules: Iterable[str] | None = None) -> list[Finding]:
    """Check a model by rules; comments such as `amuros: ignore[TIM-CLOCK]` in its files are respected.

    Parameters
    ----------
    rules : ids of the rules; all of them if none are given

    Returns
    -------
    list : the findings, by file and line.

    Raises
    ------
    InvalidArgumentError : there is no rule with an id.
    """
    if not isinstance(model, Model):
        raise TypeError(f"check() takes a Model, not {type(model).__name__}; use check_files() for paths")
    if isinstance(rules, str):
        raise TypeError(f"rules must be a list, e.g. [{rules!r}], not the string {rules!r}")
    chosen = list(registry.ids() if rules is None else rules)
    for identifier in chosen:
        if registry.profile_of(identifier) is None:
            raise unknown_rule(identifier, registry.ids())
    return sorted((finding for finding in _run(model, chosen) if not is_suppressed(finding)), key=by_place)


@reading_once()
def check_files(
    paths: StrPath | Iterable[StrPath],
    settings: CheckSettings | None = None,
    *,
    each: bool = False,
    only_amuros: bool = False,
    with_details: bool = False,
) -> CheckResult:
    """Check an `app.yaml`, or AMALTHEA models; problems found while reading the files are also reported.

    Parameters
    ----------
    settings : what is not given is taken from the project of the first file
    each : every file is a model of its own; otherwise the AMALTHEA files are one model together
    with_details : in SARIF, JUnit and baselines, also what follows from other findings, and what only counts for target tools that
        nobody asked for
    only_amuros : skip YAML files that do not describe an application, i.e. that have no key `amuros` at their top level

    Raises
    ------
    ReadError : the settings of the project are wrong.
    InvalidArgumentError : a rule does not exist, or the baseline cannot be read.
    """
    files = as_paths(paths)
    settings = (settings or CheckSettings()).over(project_settings(files[0]))
    selection = selection_of(settings)
    accepted = accepted_by(settings)
    rules = selection.rules()
    found: list[Finding] = []
    is_readable = True
    is_checked = False
    for paths_of_model in by_model(without_other_yaml(files) if only_amuros else files, each):
        try:
            found += _check_input(open_model(paths_of_model), rules)
            is_checked = True
        except ReadError as error:
            found += error.findings
            is_readable &= not is_unreadable(error.findings)
    findings = not_suppressed(found, selection, settings, accepted)
    return CheckResult(
        paths=files,
        findings=findings,
        presentation=presented(findings, selection, settings),
        fail_on=settings.fail_on or Severity.ERROR,
        is_readable=is_readable,
        rules=tuple(rules) if is_checked else (),
        with_details=with_details,
    )


def check_input(opened: ModelInput, folder: Path) -> Presentation:
    """The findings about a model that was read, as they are shown with the settings of the project in a folder.

    Raises
    ------
    ReadError : the settings of the project are wrong.
    InvalidArgumentError : they name a rule that does not exist, or a baseline that cannot be read.
    """
    settings = CheckSettings().over(project_settings(folder))
    selection = selection_of(settings)
    found = _check_input(opened, selection.rules())
    return presented(not_suppressed(found, selection, settings, accepted_by(settings)), selection, settings)


def write_baseline(result: CheckResult, path: StrPath) -> None:
    """Write a baseline that accepts the flaws that a check shows, or with details all findings.

    Raises
    ------
    WriteError : the file cannot be written.
    """
    save_text(path, baseline_text(result.findings if result.with_details else result.presentation.to_accept))


def add_rules(files: Iterable[StrPath]) -> None:
    """Make the rules of Python files known, for as long as the process runs; the files are executed.

    Raises
    ------
    ReadError : a file cannot be loaded, or the id of a rule is taken.
    """
    for file in files:
        registry.add(rules_of_file(Path(file)))


def summaries(model: Model, targets: Iterable[str]) -> Mapping[TargetTool, Sequence[FindingGroup]]:
    """What target tools make of a model, by flaw.

    Parameters
    ----------
    targets : names of the tools
    """
    return present(check(model, registry.ids(map(RuleProfile, targets)))).targets


def selection_of(settings: CheckSettings) -> Selection:
    """The rules that settings select; InvalidArgumentError if a pattern matches no rule."""
    return select(map(RuleProfile, settings.profiles), settings.select, settings.ignore)


def _check_input(opened: ModelInput, rules: Collection[str]) -> list[Finding]:
    """The findings about a model that was read, those of reading and building it included."""
    general = [finding for finding in opened.findings if _is_selected(finding, rules)]
    return sorted([*general, *_run(opened.model, rules, opened.system)], key=by_place)


def _run(model: Model, identifiers: Collection[str], system: System | None = None) -> list[Finding]:
    """The findings of rules, those that are suppressed included.

    Parameters
    ----------
    system : the one that the model was built from, if it was
    """
    rules = [registry.check(identifier) for identifier in identifiers]
    with paused_garbage_collection():
        findings = run(model, [rule for rule in rules if isinstance(rule, ModelCheck)])
        findings += _system_findings(model, system, [rule for rule in rules if isinstance(rule, SystemCheck)])
        return findings + _schema_findings(model, identifiers)


def _system_findings(model: Model, system: System | None, rules: Sequence[SystemCheck]) -> list[Finding]:
    if not rules:
        return []
    if system is None:
        from amalthea_uros.bridge.extract import extract

        system = extract(model).system
    return run_system(system, rules)


def _schema_findings(model: Model, rules: Collection[str]) -> list[Finding]:
    """The findings of the XML schema, if any of its rules is selected."""
    if set(rules).isdisjoint(registry.ids([RuleProfile.SCHEMA])):
        return []
    from amalthea_uros.xmi.schema import schema_findings

    return [f for document in model.documents for f in schema_findings(document) if f.rule in rules]


def _is_selected(finding: Finding, rules: Collection[str]) -> bool:
    """Whether a finding of reading or building belongs to no rule, or to a selected one that has no check of its own."""
    profile = registry.profile_of(finding.rule)
    return profile is None or (profile is RuleProfile.MICRO_ROS and finding.rule in rules)
