"""`amuros explain`: what a finding means."""

from __future__ import annotations

import click

from amalthea_uros.services.rules import find_kind
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import ModelCheck


@click.command("explain")
@click.argument("identifier", metavar="RULE")
def command(identifier: str) -> None:
    """Explain a rule or another kind of finding: what it reports, why that matters, what to do, and an example."""
    kind = find_kind(identifier)
    profile = registry.profile_of(kind.id)
    click.echo(f"{kind.id}: {kind.title} ({kind.severity}{f', profile {profile}' if profile else ''})\n")
    click.echo(f"{kind.rationale}\n{kind.remedy}")
    if isinstance(check := registry.check(kind.id), ModelCheck):
        click.echo(f"\nChecked objects: {_targets(check)}")
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
