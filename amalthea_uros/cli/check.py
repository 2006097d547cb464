"""`amuros check`: rules for models and descriptions."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import IO

import click

from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.metamodel.model import Model
from amalthea_uros.report.check import WRITERS
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import check
from amalthea_uros.validate.rule import Profile
from amalthea_uros.validate.suppress import baseline_text, fingerprint, is_ignored, read_baseline

#: The profile that is no set of rules, but the XML schema of a model's version.
SCHEMA = "schema"
_ORDER = (Severity.ERROR, Severity.WARNING, Severity.INFO)


@click.command("check")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL_OR_YAML...")
@click.option(
    "--profile",
    "profiles",
    multiple=True,
    type=click.Choice([SCHEMA, *map(str, Profile)]),
    help="Rules for a purpose; all by default.",
)
@click.option("--select", "selected", multiple=True, metavar="RULE", help="Only these rules; * stands for anything.")
@click.option("--ignore", "ignored", multiple=True, metavar="RULE", help="Not these rules.")
@click.option(
    "--fail-on", type=click.Choice([str(s) for s in _ORDER]), default="error", help="From which severity on the exit code is 1."
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
    known = list(registry.ids(Profile(name) for name in profiles or Profile if name != SCHEMA))
    chosen = list(_chosen(known, selected, ignored))
    model, findings = _read(paths)
    if SCHEMA in profiles or not (profiles or selected):
        from amalthea_uros.xmi.schema_findings import schema_findings

        findings += [finding for document in model.documents for finding in schema_findings(document)]
    findings += check(model, map(registry.rule, chosen))
    findings = [finding for finding in findings if not _matches(finding.rule, ignored) and not is_ignored(finding)]
    if write_baseline is not None:
        Output("baseline", write_baseline).write(partial(_write, baseline_text(findings)))
    if baseline is not None:
        try:
            accepted = read_baseline(baseline)
        except ValueError as error:
            raise click.BadParameter(str(error), param_hint="--baseline") from None
        findings = [finding for finding in findings if fingerprint(finding) not in accepted]
    for output in outputs:
        output.write(partial(WRITERS[output.format], findings, statistics))
    worst = _ORDER[: _ORDER.index(Severity(fail_on)) + 1]
    sys.exit(1 if any(finding.severity in worst for finding in findings) else 0)


def _write(text: str, stream: IO[str]) -> None:
    stream.write(text)


def _read(paths: tuple[Path, ...]) -> tuple[Model, list[Finding]]:
    """The model of files, or the one that a description becomes, whose objects know its lines."""
    if len(paths) == 1 and paths[0].suffix in (".yaml", ".yml"):
        from amalthea_uros.pipeline import build

        built = build(paths[0])
        return built.model, [finding for finding in built.assembly.findings if not finding.rule.startswith("INC-")]
    from amalthea_uros.xmi.load import load

    model = load(*paths)
    return model, list(model.findings)


def _chosen(known: list[str], selected: tuple[str, ...], ignored: tuple[str, ...]) -> Iterable[str]:
    for pattern in (*selected, *ignored):
        if not any(fnmatchcase(identifier, pattern) for identifier in registry.ids()) and pattern.startswith("INC"):
            raise click.BadParameter(f"there is no rule {pattern!r}; `amuros rules` lists them")
    for identifier in known:
        if (not selected or _matches(identifier, selected)) and not _matches(identifier, ignored):
            yield identifier


def _matches(identifier: str, patterns: Iterable[str]) -> bool:
    return any(fnmatchcase(identifier, pattern) for pattern in patterns)
