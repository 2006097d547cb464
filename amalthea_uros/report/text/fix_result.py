"""What was repaired, for people."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.report.wording.findings import joined
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.fix import FixResult


def write(result: FixResult, terminal: Terminal) -> None:
    """Write a line for each rule and model."""
    done = "repaired" if result.is_written else "would be repaired"
    for model in result.models:
        for rule, number in model.repaired.items():
            terminal.line(f"{joined(model.paths)}: {rule} {done} in {counted(number, 'object')}")
    for path in result.descriptions:
        terminal.line(f"{path}: a description is not repaired, only its author knows what is meant")
    for path, version in result.older:
        terminal.line(f"{path}: a model of {spelled(version)} is not repaired; migrate it first: amuros migrate {path}")
