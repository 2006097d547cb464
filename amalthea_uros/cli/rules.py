"""`amuros rules`: all rules."""

from __future__ import annotations

import sys

import click

from amalthea_uros.report.terminal import Terminal
from amalthea_uros.validate import registry


@click.command("rules")
def command() -> None:
    """List the rules of `amuros check`."""
    rows = []
    for identifier in registry.ids():
        rule = registry.rule(identifier)
        rows.append((rule.id, rule.severity, registry.profile_of(identifier), rule.title))
    Terminal(sys.stdout).table(("rule", "severity", "profile", "what is wrong"), rows)
