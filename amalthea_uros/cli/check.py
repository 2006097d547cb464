"""`amuros check`, `amuros rules` and `amuros explain`: rules for models and descriptions, and what they mean."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros._internal.files import STANDARD_INPUT, is_stream
from amalthea_uros.cli.output import Output, beside_files, output_option, show_text, write_outputs
from amalthea_uros.cli.parameters import INPUT, OUTPUT, Several, several
from amalthea_uros.diagnostics import Severity
from amalthea_uros.services.check import CheckStatistics, add_rules, check_files, write_baseline
from amalthea_uros.services.files import FilesDiff
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import ModelCheck, RuleProfile
from amalthea_uros.validate.settings import CheckSettings

_RULES = Several("RULE")
_profile_option = several(
    "--profile",
    "profiles",
    of=Several("PROFILE", tuple(map(str, RuleProfile))),
    text=f"Only rules for a purpose: {', '.join(RuleProfile)}. May be repeated, or given with commas.",
)


@click.command("check")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@_profile_option
@several("--select", of=_RULES, text="Only these rules, by their ids or the first letters of these, e.g. TIM,INC-EC-CYCLE.")
@several("--ignore", of=_RULES, text="Not these rules, nor other findings with these ids; e.g. INC-HW,XMI008.")
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
@click.option(
    "--details",
    "with_details",
    is_flag=True,
    help="In SARIF, JUnit and baselines, also what follows from other findings; by default, one result for each flaw.",
)
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
@output_option("CheckResult")
def check(
    paths: tuple[Path, ...],
    profiles: tuple[str, ...],
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    rule_files: tuple[Path, ...],
    fail_on: str | None,
    fix: bool,
    show_diff: bool,
    statistics: bool,
    baseline: Path | None,
    new_baseline: Path | None,
    outputs: tuple[Output, ...],
    with_details: bool,
    **which: bool,
) -> None:
    """Check models by rules.

    MODEL_OR_YAML is an app.yaml, or one or several .amxmi files or a folder with some. Problems found while reading the files are also
    reported. `amuros explain RULE` explains a rule. The settings of a project are in `[tool.amuros.check]` of its pyproject.toml, or
    in `[check]` of amuros.toml; options of the command line replace them.
    """
    if show_diff and not fix:
        raise click.UsageError("--diff shows what --fix would change; add --fix")
    if fix and any(map(is_stream, paths)):
        raise click.UsageError("--fix repairs files; standard input and pipes cannot be repaired")
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

        repairs = fix_files(paths, settings, write=not show_diff, **which)
        show_text(repairs, on_error_stream=True)
        if show_diff:
            show_text(FilesDiff(repairs.changed, "repaired"))
            sys.exit(1 if repairs.changed else 0)
    result = check_files(paths, settings, with_details=with_details, **which)
    if new_baseline is not None:
        write_baseline(result, new_baseline)
    write_outputs(outputs, result, CheckStatistics(result) if statistics else None)
    sys.exit(2 if not result.is_readable else 1 if result.fails else 0)


@click.command("rules")
@click.argument("patterns", nargs=-1, metavar="[RULE]...")
@_profile_option
@several(
    "--severity",
    "severities",
    of=Several("SEVERITY", tuple(map(str, Severity))),
    text=f"Only rules of a severity: {', '.join(Severity)}. May be repeated, or given with commas.",
)
@click.option("--search", "text", default="", metavar="TEXT", help="Only rules that mention a text, e.g. offset.")
@output_option("RulesResult")
def rules(
    patterns: tuple[str, ...],
    profiles: tuple[str, ...],
    severities: tuple[str, ...],
    text: str,
    outputs: tuple[Output, ...],
) -> None:
    """List the rules of `amuros check`.

    RULE is the id of a rule, or the first letters of ids: `amuros rules TIM INC-HW`. With several conditions, a rule meets all of them.
    """
    from amalthea_uros.services.rules import find_rules

    result = find_rules(patterns, profiles=map(RuleProfile, profiles), severities=map(Severity, severities), text=text)
    write_outputs(outputs, result)


@click.command("explain")
@click.argument("identifier", metavar="RULE")
def explain(identifier: str) -> None:
    """Explain a rule or another kind of finding: what it reports, why that matters, what to do, and an example."""
    from amalthea_uros.services.rules import find_kind

    kind = find_kind(identifier)
    profile = registry.profile_of(kind.id)
    about = [kind.severity, *filter(None, (kind.effect, profile and f"profile {profile}"))]
    click.echo(f"{kind.id}: {kind.title} ({', '.join(about)})\n")
    click.echo(f"{kind.rationale}\n{kind.remedy}")
    if isinstance(model_check := registry.check(kind.id), ModelCheck):
        click.echo(f"\nChecked objects: {_targets(model_check)}")
    if kind.beside is not None:
        click.echo(f"\nWith another file of the model:\n{kind.beside.rstrip()}")
    if kind.fails:
        click.echo(f"\nFails:\n\n{kind.fails.strip()}")
    if kind.passes:
        click.echo(f"\nPasses:\n\n{kind.passes.strip()}")
    if (url := registry.rule_url(kind.id)) is not None:
        click.echo(f"\nSee {url}")


def _targets(rule: ModelCheck) -> str:
    """The classes of objects, and the AMALTHEA versions, that a rule checks."""
    targets = rule.target if isinstance(rule.target, tuple) else (rule.target,)
    versions = [f" since AMALTHEA {rule.since}"] if rule.since else []
    versions += [f" up to AMALTHEA {rule.until}"] if rule.until else []
    return ", ".join(target.__name__ for target in targets) + "".join(versions)
