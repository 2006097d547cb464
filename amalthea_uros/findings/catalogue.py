"""The kinds of findings that no rule of `validate` reports.

Each family of ids is a file in `families`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.findings.kind import FindingKind, ids_in, kind_in

#: The letters with which the ids of a family start, and where its findings come from.
FAMILIES = {
    "XMI": "Reading and writing models",
    "YML": "Reading app.yaml",
    "CFG": "Settings of a project",
    "APP": "Content of app.yaml",
    "EXE": "Executors that spin in loops",
    "HST": "Executors of ROS 2 on the host",
    "BLD": "Building a model",
    "GEN": "Generating and checking build options",
    "EXT": "Extracting the performance model",
    "INC": "Writing and reading INCHRON projects",
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

#: What the ids of findings about the content of a readable description start with; `YML00` is for texts that are no YAML.
_CONTENT = ("YML01", "APP", "UR1", "EXE")

_FOLDER = Path(__file__).parent / "families"
_ID = re.compile(r"([A-Z]{2,3})\d{3}")


def kinds(family: str) -> tuple[FindingKind, ...]:
    """The kinds of findings of a family, by id; none if there is no such family."""
    file = _file(family)
    return tuple(kind_in(file, identifier) for identifier in ids_in(file)) if file.exists() else ()


def ids_of(family: str) -> tuple[str, ...]:
    """The ids of a family."""
    return ids_in(_file(family))


def ids() -> Iterator[str]:
    """The ids of all kinds of findings that are reported without being asked for."""
    return (identifier for family in FAMILIES for identifier in ids_of(family))


def find(identifier: str) -> FindingKind | None:
    """A kind of finding by its id, None if no family has it."""
    match = _ID.fullmatch(identifier)
    file = _file(match[1]) if match is not None else None
    return kind_in(file, identifier) if file is not None and file.exists() and identifier in ids_in(file) else None


def is_unreadable(findings: Iterable[Finding]) -> bool:
    """Whether one of the errors that ended the reading is about more than the content of a description."""
    ending = [finding for finding in findings if finding.severity is Severity.ERROR]
    return any(not finding.rule.startswith(_CONTENT) for finding in ending)


def _file(family: str) -> Path:
    return _FOLDER / f"{family.lower()}.yaml"
