"""`amuros check`: rules for models and descriptions."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path

import click

from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.metamodel.model import Model
from amalthea_uros.report.check import WRITERS
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import check
from amalthea_uros.validate.rule import Profile

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
@output_option("text", "json", "sarif", "junit", "github")
def command(
    paths: tuple[Path, ...],
    profiles: tuple[str, ...],
    selected: tuple[str, ...],
    ignored: tuple[str, ...],
    fail_on: str,
    statistics: bool,
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
    findings = [finding for finding in findings if not _matches(finding.rule, ignored)]
    for output in outputs:
        output.write(partial(WRITERS[output.format], findings, statistics))
    worst = _ORDER[: _ORDER.index(Severity(fail_on)) + 1]
    sys.exit(1 if any(finding.severity in worst for finding in findings) else 0)


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
