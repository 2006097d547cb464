"""The kinds of findings that no rule reports; one module for each family of ids, imported when one of them is needed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module

from amalthea_uros.findings.kind import FindingKind

#: The letters with which the ids of a family start, and where its findings come from.
FAMILIES = {
    "XMI": "Reading and writing models",
    "YML": "Reading app.yaml",
    "CFG": "Settings of a project",
    "APP": "Content of app.yaml",
    "EXE": "Executors that spin in loops",
    "BLD": "Building a model",
    "EXT": "Extracting the performance model",
    "ANA": "Analysing response times",
    "SIM": "Simulating systems",
    "CHN": "Analysing event chains",
    "CAN": "Reading logs of CAN buses",
    "CMP": "Comparing predictions with measurements",
    "TRC": "Reading, checking and writing traces",
    "MEA": "Measuring times in traces",
    "CAL": "Putting measured values into a description",
    "RUL": "Loading user-made rules",
    "CHK": "Running rules",
}

_ID = re.compile(r"([A-Z]{3})\d{3}")


def kinds(family: str) -> tuple[FindingKind, ...]:
    """The kinds of findings of a family, by id."""
    found: tuple[FindingKind, ...] = import_module(f"amalthea_uros.findings.families.{family.lower()}").KINDS
    return found


def ids() -> Iterator[str]:
    """The ids of all kinds of findings that no rule reports."""
    return (kind.id for family in FAMILIES for kind in kinds(family))


def find(identifier: str) -> FindingKind | None:
    """A kind of finding by its id, None if no family has it."""
    match = _ID.fullmatch(identifier)
    if match is None or match[1] not in FAMILIES:
        return None
    return next((kind for kind in kinds(match[1]) if kind.id == identifier), None)
