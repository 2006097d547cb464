"""`amuros check`: rules for models and descriptions."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros._internal.files import STANDARD_INPUT
from amalthea_uros.cli.files import INPUT, OUTPUT
from amalthea_uros.cli.output import Output, beside_files, output_option, show_text, write_outputs
from amalthea_uros.cli.several import Several, several
from amalthea_uros.diagnostics import Severity
from amalthea_uros.services.check import CheckResult, CheckStatistics, add_rules, check_files, write_baseline
from amalthea_uros.services.file_changes import FilesDiff
from amalthea_uros.services.settings import CheckSettings
from amalthea_uros.validate.rule import RuleProfile

_PROFILES = Several("PROFILE", tuple(map(str, RuleProfile)))
_RULES = Several("RULE")


@click.command("check")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@click.option(
    "--profile",
    "profiles",
    type=_PROFILES,
    multiple=True,
    callback=several,
    help=f"Only rules for a purpose: {', '.join(RuleProfile)}. May be repeated, or given with commas.",
)
@click.option(
    "--select",
    type=_RULES,
    multiple=True,
    callback=several,
    help="Only these rules, by their ids or the first letters of these, e.g. TIM,INC-EC-CYCLE.",
)
@click.option(
    "--ignore",
    type=_RULES,
    multiple=True,
    callback=several,
    help="Not these rules, nor other findings with these ids; e.g. INC-HW,XMI008.",
)
@click.option(
    "--rules",
    "rule_files",
    type=INPUT,
    multiple=True,
    metavar="FILE",
    help="Also run the rules of a Python file, which is executed. May be repeated.",
)
@click.option(
    "--fail-on",
    type=click.Choice(list(map(str, Severity))),
    help="Minimum severity that makes the exit code 1; error by default.",
)
@click.option(
    "--each", is_flag=True, help="Check every .amxmi file as a model of its own; otherwise they are one model together."
)
@click.option("--only-amuros", is_flag=True, help="Skip YAML files without the key 'amuros', which are of other programs.")
@click.option("--fix", is_flag=True, help="First repair what can be repaired in only one way.")
@click.option(
    "--diff",
    "show_diff",
    is_flag=True,
    help="With --fix: write nothing and do not check; show what would be repaired, exit code 1 if anything would.",
)
@click.option("--statistics", is_flag=True, help="Show how often each rule fires instead of each finding.")
@click.option("--baseline", type=INPUT, metavar="FILE", help="Hide the findings that a baseline accepts.")
@click.option("--write-baseline", "new_baseline", type=OUTPUT, metavar="FILE", help="Accept all current findings.")
@output_option(CheckResult)
def command(
    paths: tuple[Path, ...],
    profiles: tuple[str, ...],
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    rule_files: tuple[Path, ...],
    fail_on: str | None,
    each: bool,
    only_amuros: bool,
    fix: bool,
    show_diff: bool,
    statistics: bool,
    baseline: Path | None,
    new_baseline: Path | None,
    outputs: tuple[Output, ...],
) -> None:
    """Check models by rules.

    MODEL_OR_YAML is an app.yaml, or one or several .amxmi files or a folder with some. Problems found while reading the files are also
    reported. `amuros explain RULE` explains a rule. The settings of a project are in `[tool.amuros.check]` of its pyproject.toml, or
    in `[check]` of amuros.toml; options of the command line replace them.
    """
    if show_diff and not fix:
        raise click.UsageError("--diff shows what --fix would change; add --fix")
    if fix and STANDARD_INPUT in paths:
        raise click.UsageError("--fix repairs files; standard input cannot be repaired")
    if [*paths, *rule_files, baseline].count(STANDARD_INPUT) > 1:
        raise click.UsageError("standard input can be only one of the files that are read")
    outputs = beside_files(outputs, [("--write-baseline", new_baseline)])
    add_rules(rule_files)
    settings = CheckSettings(
        profiles=(*profiles, RuleProfile.USER) if profiles and rule_files else profiles,
        select=select,
        ignore=ignore,
        fail_on=Severity(fail_on) if fail_on else None,
        baseline=baseline,
    )
    if fix:
        from amalthea_uros.services.fix import fix_files

        repairs = fix_files(paths, settings, each=each, only_amuros=only_amuros, write=not show_diff)
        show_text(repairs, on_error_stream=True)
        if show_diff:
            show_text(FilesDiff(repairs.changed, "repaired"))
            sys.exit(1 if repairs.changed else 0)
    result = check_files(paths, settings, each=each, only_amuros=only_amuros)
    if new_baseline is not None:
        write_baseline(result, new_baseline)
    write_outputs(outputs, result, CheckStatistics(result) if statistics else None)
    sys.exit(2 if not result.is_readable else 1 if result.fails else 0)
