"""`amuros check`: rules for models and descriptions."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import IO

import click

from amalthea_uros.checking import check_files
from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.diagnostics import Severity
from amalthea_uros.report.check import WRITERS, write_statistics
from amalthea_uros.validate.rule import Profile
from amalthea_uros.validate.selection import Selection
from amalthea_uros.validate.suppress import baseline_text, fingerprint, is_ignored, read_baseline

_SEVERITIES = list(Severity)


@click.command("check")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL_OR_YAML...")
@click.option(
    "--profile",
    "profiles",
    multiple=True,
    type=click.Choice(list(map(str, Profile))),
    help="Rules for a purpose; all by default.",
)
@click.option("--select", "selected", multiple=True, metavar="RULE", help="Only these rules; * stands for anything.")
@click.option("--ignore", "ignored", multiple=True, metavar="RULE", help="Not these rules.")
@click.option(
    "--fail-on",
    type=click.Choice(list(map(str, Severity))),
    default="error",
    show_default=True,
    help="From which severity on the exit code is 1.",
)
@click.option("--statistics", is_flag=True, help="Show how often each rule fires instead of each finding.")
@click.option("--baseline", type=click.Path(path_type=Path), metavar="FILE", help="Hide the findings that a baseline accepts.")
@click.option("--write-baseline", type=click.Path(path_type=Path), metavar="FILE", help="Accept all findings of today.")
@output_option("text", "json", "sarif", "junit", "github")
def command(
    paths: tuple[Path, ...],
    profiles: tuple[str, ...],
    selected: tuple[str, ...],
    ignored: tuple[str, ...],
    fail_on: str,
    statistics: bool,
    baseline: Path | None,
    write_baseline: Path | None,
    outputs: tuple[Output, ...],
) -> None:
    """Check models by rules.

    MODEL_OR_YAML is an app.yaml, or one or several .amxmi files or a folder with some. What is odd about the files themselves is told,
    too. `amuros explain RULE` tells more about a rule.
    """
    selection = Selection(profiles=tuple(map(Profile, profiles)), selected=selected, ignored=ignored)
    for pattern in selection.unknown():
        raise click.BadParameter(f"there is no rule {pattern!r}; `amuros rules` lists them", param_hint="--select")
    accepted = _accepted(baseline)
    findings = [
        finding
        for finding in check_files(paths, selection.rules())
        if not (selection.is_ignored(finding.rule) or is_ignored(finding) or fingerprint(finding) in accepted)
    ]
    if write_baseline is not None:
        Output("baseline", write_baseline).write(partial(_write, baseline_text(findings)))
    model = " ".join(map(str, paths))
    for output in outputs:
        writer = write_statistics if statistics and output.format == "text" else WRITERS[output.format]
        output.write(partial(writer, findings, model))
    failing = _SEVERITIES[: _SEVERITIES.index(Severity(fail_on)) + 1]
    sys.exit(1 if any(finding.severity in failing for finding in findings) else 0)


def _accepted(baseline: Path | None) -> set[str]:
    try:
        return read_baseline(baseline) if baseline is not None else set()
    except ValueError as error:
        raise click.BadParameter(str(error), param_hint="--baseline") from None


def _write(text: str, stream: IO[str]) -> None:
    stream.write(text)
