"""Findings of reading an app.yaml."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="YML001",
        title="file that is not valid YAML",
        severity=Severity.ERROR,
        rationale=(
            "The file cannot be read, is not valid YAML, or uses YAML features that a description must not use: "
            "tags, several documents, keys that are not text."
        ),
        remedy="Correct the syntax at this place.",
        fails="""
amuros: 1
name: app
tasks: [
""",
    ),
    FindingKind(
        id="YML002",
        title="file that is too large or nested too deeply",
        severity=Severity.ERROR,
        rationale="Such content could exhaust the memory, so it is refused. Every use of an alias counts as a copy.",
        remedy="Use fewer aliases; if the file can be trusted, set AMUROS_LIMITS=4 in the environment for four times as much.",
    ),
    FindingKind(
        id="YML003",
        title="duplicate key",
        severity=Severity.ERROR,
        rationale="Only the first value would be used, so one of the two would have no effect.",
        remedy="Keep one of the two.",
        fails="""
amuros: 1
name: app
name: other
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: 1 ms}
""",
    ),
    FindingKind(
        id="YML010",
        title="unknown key",
        severity=Severity.ERROR,
        rationale="A key that is not understood would have no effect, so it is refused.",
        remedy="Correct the key; amuros schema lists all keys.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, perod: 10 ms, execution_time: 1 ms}
""",
    ),
    FindingKind(
        id="YML011",
        title="missing key",
        severity=Severity.ERROR,
        rationale="The section is incomplete without this key.",
        remedy="Add the key.",
        fails="""
amuros: 1
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10 ms, execution_time: 1 ms}
""",
    ),
    FindingKind(
        id="YML012",
        title="value of the wrong type",
        severity=Severity.ERROR,
        rationale="The value has no unit, is out of range, or is not one of the allowed words.",
        remedy="Write a value of the type that the key requires; times need a unit, such as 10 ms.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: T, period: 10, execution_time: 1 ms}
""",
    ),
)
