"""`amuros explain`: what a rule is about."""

from __future__ import annotations

import click

from amalthea_uros.validate import registry


@click.command("explain")
@click.argument("identifier", metavar="RULE")
def command(identifier: str) -> None:
    """Tell what a rule looks for, why, and what to do, with an example."""
    profile = registry.profile_of(identifier)
    if profile is None:
        raise click.BadParameter(f"there is no rule {identifier!r}; `amuros rules` lists them")
    rule = registry.rule(identifier)
    click.echo(f"{rule.id}: {rule.title} ({rule.severity}, profile {profile})\n")
    click.echo(f"{rule.rationale}\n{rule.remedy}\n")
    click.echo(f"It fires at:\n{rule.fails.rstrip()}\n\nIt does not at:\n{rule.passes.rstrip()}")
