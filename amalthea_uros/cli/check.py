"""`amuros check`: rules for models and descriptions."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import IO

import click

from amalthea_uros.checking import check_files, fix_files, is_description
from amalthea_uros.cli.configuration import configuration_of
from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.findings.baseline import baseline_text, read_baseline
from amalthea_uros.findings.fingerprint import fingerprint
from amalthea_uros.findings.presentation import present
from amalthea_uros.findings.suppression import is_suppressed
from amalthea_uros.findings.targets import TARGETS
from amalthea_uros.report.check import WRITERS, write_statistics
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import Profile
from amalthea_uros.validate.selection import Selection
from amalthea_uros.validate.user_rules import rules_of_file

_SEVERITIES = list(map(str, Severity))

#: Findings about a file of which nothing can be said.
_UNREADABLE = ("XMI", "YML00")


class _Several(click.ParamType[str]):
    """One word, or several with commas between them."""

    def __init__(self, name: str, allowed: Sequence[str] = ()) -> None:
        self.name = name
        self.allowed = allowed

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Check the words."""
        for word in value.split(","):
            if self.allowed and word not in self.allowed:
                self.fail(f"{word!r} is not one of {', '.join(self.allowed)}", param, ctx)
        return value


def _several(_context: click.Context, _parameter: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(word for value in values for word in value.split(","))


_PROFILES = _Several("PROFILE", tuple(map(str, Profile)))
_RULES = _Several("RULE")


@click.command("check")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL_OR_YAML...")
@click.option(
    "--profile",
    "profiles",
    type=_PROFILES,
    multiple=True,
    callback=_several,
    help=f"Only rules for a purpose: {', '.join(Profile)}. May be repeated, also with commas.",
)
@click.option(
    "--select", "selected", type=_RULES, multiple=True, callback=_several, help="Only these rules; * stands for anything."
)
@click.option("--ignore", "ignored", type=_RULES, multiple=True, callback=_several, help="Not these rules.")
@click.option(
    "--rules",
    "rule_files",
    type=click.Path(path_type=Path),
    multiple=True,
    metavar="FILE",
    help="Also run the rules of a Python file, which is executed. May be repeated.",
)
@click.option("--fail-on", type=click.Choice(_SEVERITIES), help="From which severity on the exit code is 1; error by default.")
@click.option("--each", is_flag=True, help="Every .amxmi file is a model of its own; otherwise they are one model together.")
@click.option("--fix", is_flag=True, help="Repair what can be repaired in one way only, then check.")
@click.option("--statistics", is_flag=True, help="Show how often each rule fires instead of each finding.")
@click.option("--baseline", type=click.Path(path_type=Path), metavar="FILE", help="Hide the findings that a baseline accepts.")
@click.option("--write-baseline", type=click.Path(path_type=Path), metavar="FILE", help="Accept all findings of today.")
@output_option("text", "json", "sarif", "junit", "github")
def command(
    paths: tuple[Path, ...],
    profiles: tuple[str, ...],
    selected: tuple[str, ...],
    ignored: tuple[str, ...],
    rule_files: tuple[Path, ...],
    fail_on: str | None,
    each: bool,
    fix: bool,
    statistics: bool,
    baseline: Path | None,
    write_baseline: Path | None,
    outputs: tuple[Output, ...],
) -> None:
    """Check models by rules.

    MODEL_OR_YAML is an app.yaml, or one or several .amxmi files or a folder with some. What is odd about the files themselves is told,
    too. `amuros explain RULE` tells more about a rule. Settings of a project stand in `[tool.amuros.check]` of its pyproject.toml, or
    in `[check]` of amuros.toml; what is given here takes their place.
    """
    settings = configuration_of(paths[0])
    for file in rule_files:
        registry.add(rules_of_file(file))
    profiles = profiles or settings.profile
    if profiles and rule_files:
        profiles = (*profiles, str(Profile.USER))
    selection = _selection(profiles, selected or settings.select, ignored or settings.ignore)
    groups = list(_groups(paths, each))
    if fix:
        _fix(groups, selection)
    accepted = _accepted(baseline or settings.baseline)
    told, is_readable = _told(groups, selection)
    findings = [
        finding
        for finding in told
        if not (selection.is_ignored(finding.rule) or is_suppressed(finding) or fingerprint(finding) in accepted)
    ]
    if write_baseline is not None:
        Output("baseline", write_baseline).write(partial(_write, baseline_text(findings)))
    model = " ".join(map(str, paths))
    presentation = present(findings, _asked(selection, settings.targets))
    for output in outputs:
        writer = write_statistics if statistics and output.format == "text" else WRITERS[output.format]
        output.write(partial(writer, presentation, model))
    sys.exit(2 if not is_readable else 1 if _fails(presentation.shown, fail_on or settings.fail_on) else 0)


def _selection(profiles: Sequence[str], selected: Sequence[str], ignored: Sequence[str]) -> Selection:
    selection = Selection(profiles=tuple(map(Profile, profiles)), selected=tuple(selected), ignored=tuple(ignored))
    for pattern in selection.unknown():
        raise click.BadParameter(f"there is no rule {pattern!r}; `amuros rules` lists them", param_hint="--select")
    return selection


def _asked(selection: Selection, targets: Iterable[str]) -> set[str]:
    """The target tools whose findings count: those of the settings and profiles, and those of which rules are selected."""
    selected = TARGETS if selection.selected else ()
    return {*targets, *map(str, selection.profiles), *(target.name for target in selected)}


def _groups(paths: Iterable[Path], each: bool) -> Iterable[list[Path]]:
    """What belongs together: a description is always a model of its own."""
    models = []
    for path in paths:
        if each or is_description(path):
            yield [path]
        else:
            models.append(path)
    if models:
        yield models


def _fix(groups: Iterable[Sequence[Path]], selection: Selection) -> None:
    for group in groups:
        if is_description(group[0]):
            click.echo(f"{group[0]}: a description is not repaired, its author knows what is meant", err=True)
            continue
        for rule, number in fix_files(group, selection.rules()).items():
            click.echo(f"{' '.join(map(str, group))}: {rule} repaired at {number} object{'s' if number > 1 else ''}", err=True)


def _told(groups: Iterable[Sequence[Path]], selection: Selection) -> tuple[list[Finding], bool]:
    """All findings, also those that keep a model from being read or built, and whether every file could be read."""
    found: list[Finding] = []
    is_readable = True
    for group in groups:
        try:
            found += check_files(group, selection.rules())
        except ReadError as error:
            found += error.findings
            is_readable &= not any(finding.rule.startswith(_UNREADABLE) for finding in error.findings)
    return found, is_readable


def _accepted(baseline: Path | None) -> set[str]:
    try:
        return read_baseline(baseline) if baseline is not None else set()
    except ValueError as error:
        raise click.BadParameter(str(error), param_hint="--baseline") from None


def _fails(findings: Iterable[Finding], fail_on: str) -> bool:
    failing = _SEVERITIES[: _SEVERITIES.index(fail_on) + 1]
    return any(finding.severity in failing for finding in findings)


def _write(text: str, stream: IO[str]) -> None:
    stream.write(text)
