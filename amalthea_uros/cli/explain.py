"""`amuros explain`: a rule or another finding, explained."""

from __future__ import annotations

import re

import click

from amalthea_uros._internal.resources import resource_folder
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import ModelRule


@click.command("explain")
@click.argument("identifier", metavar="RULE")
def command(identifier: str) -> None:
    """Explain what a rule looks for, why, and what to do, with an example; or what another finding means."""
    profile = registry.profile_of(identifier)
    if profile is None:
        click.echo(_finding(identifier.upper()))
        return
    rule = registry.rule(identifier)
    click.echo(f"{rule.id}: {rule.title} ({rule.severity}, profile {profile})\n")
    click.echo(f"{rule.rationale}\n{rule.remedy}\n")
    if isinstance(rule, ModelRule):
        click.echo(f"Checked objects: {_targets(rule)}\n")
        if rule.beside is not None:
            click.echo(f"With another file of the model:\n{rule.beside.rstrip()}\n")
    click.echo(f"Fails:\n{rule.fails.rstrip()}\n\nPasses:\n{rule.passes.rstrip()}")


def _targets(rule: ModelRule) -> str:
    """The classes of objects, and the AMALTHEA versions, that a rule checks."""
    targets = rule.target if isinstance(rule.target, tuple) else (rule.target,)
    versions = [f" since AMALTHEA {rule.since}"] if rule.since else []
    versions += [f" up to AMALTHEA {rule.until}"] if rule.until else []
    return ", ".join(target.__name__ for target in targets) + "".join(versions)


def _finding(identifier: str) -> str:
    """The entry of a finding that no rule reports, from the page of the findings."""
    page = (resource_folder("docs") / "findings.md").read_text(encoding="utf-8")
    found = re.search(rf"^\| {re.escape(identifier)} \| ([^|]*) \| (.*) \|$", page, re.MULTILINE)
    if found is None:
        raise click.BadParameter(f"unknown rule {identifier!r}; `amuros rules` lists all rules")
    return f"{identifier}: {found[2]} ({found[1]})"
