"""A list of rules for people."""

from __future__ import annotations

from amalthea_uros.report.wording.findings import profile_name
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.rules import RulesResult


def write(result: RulesResult, terminal: Terminal) -> None:
    """Write a row for each rule."""
    if not result.rules:
        terminal.line("no rules")
        return
    rows = [(rule.id, rule.severity, profile_name(rule.id), rule.title) for rule in result.rules]
    terminal.table(("rule", "severity", "profile", "what is wrong"), rows)
