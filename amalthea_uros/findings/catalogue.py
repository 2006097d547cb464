"""The kinds of findings that no rule of `validate` reports.

The entries of each family of ids are a file in `families`, which is read when one of them is needed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from string import Template
from typing import Any

from amalthea_uros._internal.resources import yaml_data
from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

#: The letters with which the ids of a family start, and where its findings come from.
FAMILIES = {
    "XMI": "Reading and writing models",
    "YML": "Reading app.yaml",
    "CFG": "Settings of a project",
    "APP": "Content of app.yaml",
    "EXE": "Executors that spin in loops",
    "BLD": "Building a model",
    "GEN": "Generating and checking build options",
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
    "IMP": "Importing source code",
}

_FOLDER = Path(__file__).parent / "families"
_ID = re.compile(r"([A-Z]{2,3})\d{3}")
_ENTRY = re.compile(rf"^({_ID.pattern}):$", re.MULTILINE)


@cache
def kinds(family: str) -> tuple[FindingKind, ...]:
    """The kinds of findings of a family, by id; none if there is no such family."""
    entries: dict[str, dict[str, Any]] = yaml_data(_file(family)) if _file(family).exists() else {}
    snippets = entries.pop("snippets", {})
    return tuple(_kind(identifier, entry, snippets) for identifier, entry in entries.items())


def _kind(identifier: str, entry: dict[str, Any], snippets: Mapping[str, str]) -> FindingKind:
    """A kind of finding as it is written in its file; `$name` in its example is a text that several examples share."""
    fails = Template(entry.pop("fails", "")).substitute(snippets)
    return FindingKind(id=identifier, severity=Severity(entry.pop("severity")), fails=fails, **entry)


@cache
def ids_of(family: str) -> tuple[str, ...]:
    """The ids of a family, without reading the rest of its entries."""
    return tuple(found[0] for found in _ENTRY.findall(_file(family).read_text(encoding="utf-8")))


def ids() -> Iterator[str]:
    """The ids of all kinds of findings that are reported without being asked for."""
    return (identifier for family in FAMILIES for identifier in ids_of(family))


def find(identifier: str) -> FindingKind | None:
    """A kind of finding by its id, None if no family has it."""
    match = _ID.fullmatch(identifier)
    return next((kind for kind in kinds(match[1]) if kind.id == identifier), None) if match is not None else None


def _file(family: str) -> Path:
    return _FOLDER / f"{family.lower()}.yaml"
