"""`amuros rules`: the rules of check."""

from __future__ import annotations

import click

from amalthea_uros.cli.output import Output, output_option, write_outputs
from amalthea_uros.cli.several import Several, several
from amalthea_uros.diagnostics import Severity
from amalthea_uros.services.rules import RulesResult, find_rules
from amalthea_uros.validate.rule import RuleProfile


@click.command("rules")
@click.argument("patterns", nargs=-1, metavar="[RULE]...")
@click.option(
    "--profile",
    "profiles",
    type=Several("PROFILE", tuple(map(str, RuleProfile))),
    multiple=True,
    callback=several,
    help=f"Only rules for a purpose: {', '.join(RuleProfile)}. May be repeated, or given with commas.",
)
@click.option(
    "--severity",
    "severities",
    type=Several("SEVERITY", tuple(map(str, Severity))),
    multiple=True,
    callback=several,
    help=f"Only rules of a severity: {', '.join(Severity)}. May be repeated, or given with commas.",
)
@click.option("--search", "text", default="", metavar="TEXT", help="Only rules that mention a text, e.g. offset.")
@output_option(RulesResult)
def command(
    patterns: tuple[str, ...],
    profiles: tuple[str, ...],
    severities: tuple[str, ...],
    text: str,
    outputs: tuple[Output, ...],
) -> None:
    """List the rules of `amuros check`.

    RULE is the id of a rule, or the first letters of ids: `amuros rules TIM INC-HW`. With several conditions, a rule meets all of them.
    """
    result = find_rules(patterns, profiles=map(RuleProfile, profiles), severities=map(Severity, severities), text=text)
    write_outputs(outputs, result)
