"""Models and descriptions checked by rules."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros.diagnostics import Finding, Severity, by_place
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.metamodel.model import Model
from amalthea_uros.services.inputs import StrPath, as_paths, by_model, open_model
from amalthea_uros.services.settings import CheckSettings, project_settings
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import run
from amalthea_uros.validate.rule import ModelRule, Profile
from amalthea_uros.validate.selection import Selection
from amalthea_uros.validate.suppress import baseline_text, fingerprint, is_ignored, read_baseline

#: What reading reports in general, and the rules that report it for each object.
_REPORTED_BY_RULES = {
    "XMI010": ("INC-IO-FEATURE",),
    "XMI011": ("INC-IO-FEATURE",),
    "XMI012": ("INC-IO-FEATURE",),
    "XMI013": ("INC-IO-FEATURE",),
    "XMI020": ("AM-EMF-INTRINSIC/proxy-resolves", "INC-IO-REF"),
    "XMI021": ("AM-EMF-SCOPE", "INC-IO-NAME"),
}

#: Findings about a file that could not be checked at all.
_UNREADABLE = ("XMI", "YML00")


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckResult:
    """The findings about some files that are not suppressed, by file and line.

    Attributes
    ----------
    fail_on : minimum severity at which the check fails
    is_readable : whether every file could be checked
    """

    paths: tuple[Path, ...]
    findings: tuple[Finding, ...]
    fail_on: Severity
    is_readable: bool

    @property
    def fails(self) -> bool:
        """Whether a finding is at least as severe as `fail_on`."""
        failing = tuple(Severity)[: tuple(Severity).index(self.fail_on) + 1]
        return any(finding.severity in failing for finding in self.findings)


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
            raise InvalidArgumentError(f"unknown rule {identifier!r}; `amuros rules` lists all rules")
    return sorted((finding for finding in _run(model, chosen) if not is_ignored(finding)), key=by_place)


def check_files(
    paths: StrPath | Iterable[StrPath], settings: CheckSettings | None = None, *, each: bool = False
) -> CheckResult:
    """Check an `app.yaml`, or AMALTHEA models; problems found while reading the files are also reported.

    Parameters
    ----------
    settings : what is not given is taken from the project of the first file
    each : every file is a model of its own; otherwise the AMALTHEA files are one model together

    Raises
    ------
    ReadError : the settings of the project are wrong.
    InvalidArgumentError : a rule does not exist, or the baseline cannot be read.
    """
    files = as_paths(paths)
    settings = (settings or CheckSettings()).over(project_settings(files[0]))
    selection = selection_of(settings)
    accepted = _accepted(settings.baseline)
    rules = selection.rules()
    found: list[Finding] = []
    is_readable = True
    for group in by_model(files, each):
        try:
            found += _check_group(group, rules)
        except ReadError as error:
            found += error.findings
            is_readable &= not any(finding.rule.startswith(_UNREADABLE) for finding in error.findings)
    return CheckResult(
        paths=files,
        findings=tuple(finding for finding in found if _is_shown(finding, selection, accepted)),
        fail_on=settings.fail_on or Severity.ERROR,
        is_readable=is_readable,
    )


def write_baseline(result: CheckResult, path: StrPath) -> None:
    """Write a baseline that accepts all findings of a check.

    Raises
    ------
    WriteError : the file cannot be written.
    """
    from amalthea_uros.xmi.files import FileText, write_text

    write_text(Path(path), FileText(baseline_text(result.findings)))


def selection_of(settings: CheckSettings) -> Selection:
    """The rules that settings select.

    Raises
    ------
    InvalidArgumentError : a pattern matches no rule.
    """
    selection = Selection(
        profiles=tuple(map(Profile, settings.profiles)), selected=tuple(settings.select), ignored=tuple(settings.ignore)
    )
    for pattern in selection.unknown():
        raise InvalidArgumentError(f"unknown rule {pattern!r}; `amuros rules` lists all rules")
    return selection


def _accepted(baseline: Path | None) -> Collection[str]:
    try:
        return read_baseline(baseline) if baseline is not None else ()
    except ValueError as error:
        raise InvalidArgumentError(str(error)) from None


def _is_shown(finding: Finding, selection: Selection, accepted: Collection[str]) -> bool:
    """Whether a finding is not suppressed in any way."""
    return not (selection.is_ignored(finding.rule) or is_ignored(finding) or fingerprint(finding) in accepted)


def _check_group(paths: Sequence[Path], rules: Collection[str]) -> list[Finding]:
    """The findings about one model, those of reading and building it included."""
    opened = open_model(paths)
    findings = _run(opened.model, rules)
    places = {(finding.rule, _line(finding)) for finding in findings}
    general = [f for f in opened.findings if _is_selected(f, rules) and not _is_repeated(f, places)]
    return sorted([*general, *findings], key=by_place)


def _run(model: Model, rules: Collection[str]) -> list[Finding]:
    """The findings of rules, those that are suppressed included."""
    with paused_garbage_collection():
        findings = run(model, [rule for rule in map(registry.rule, rules) if isinstance(rule, ModelRule)])
        return findings + _schema_findings(model, rules)


def _schema_findings(model: Model, rules: Collection[str]) -> list[Finding]:
    """The findings of the XML schema, if any of its rules is selected."""
    if set(rules).isdisjoint(registry.ids([Profile.SCHEMA])):
        return []
    from amalthea_uros.xmi.schema_findings import schema_findings

    return [f for document in model.documents for f in schema_findings(document) if f.rule in rules]


def _is_selected(finding: Finding, rules: Collection[str]) -> bool:
    """Whether a finding of reading or building belongs to no rule, or to a selected one that has no check of its own."""
    profile = registry.profile_of(finding.rule)
    return profile is None or (profile is Profile.MICRO_ROS and finding.rule in rules)


def _is_repeated(finding: Finding, places: Collection[tuple[str, object]]) -> bool:
    """Whether rules report the same at the same line."""
    return any((rule, _line(finding)) in places for rule in _REPORTED_BY_RULES.get(finding.rule, ()))


def _line(finding: Finding) -> tuple[Path, int | None] | None:
    return (finding.location.path, finding.location.line) if finding.location is not None else None
