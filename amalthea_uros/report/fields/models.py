"""The fields of what is done with models: checks, differences, versions, summaries, and the rules."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from amalthea_uros.design.changes.timing_changes import TimingChange
from amalthea_uros.difference.comparison import ModelChange
from amalthea_uros.findings.accepted import fingerprint
from amalthea_uros.metamodel.element import Element
from amalthea_uros.report.fields import changes
from amalthea_uros.report.fields.declaration import ALSO, declare, given, json_of, list_of
from amalthea_uros.report.wording.findings import joined, profile_name
from amalthea_uros.services.check import CheckResult
from amalthea_uros.services.diff import DiffResult
from amalthea_uros.services.info import InfoResult
from amalthea_uros.services.migrate import MigratedFile, MigrationChange, MigrationResult
from amalthea_uros.services.rules import RulesResult

#: Declares differences and impacts.
_USED = changes
_KINDS = {"kept as custom property": "kept_as_property"}


def _findings(result: CheckResult) -> list[dict[str, Any]]:
    """All findings, with the profiles of their rules and the findings under which they are shown."""
    return [
        {
            **json_of(finding),
            "profile": profile_name(finding.rule),
            "fingerprint": fingerprint(finding),
            "part_of": part_of,
            "counts": counts,
        }
        for finding, part_of, counts in result.presentation.entries()
    ]


def _place(element: Element | None, feature: str) -> dict[str, Any] | None:
    """The place of an object or its attribute, None if it was not read from a file."""
    document = element.document if element is not None else None
    if element is None or document is None or document.source is None or element not in document.source.index:
        return None
    line, column = document.source.position_of(element, feature)
    return {"file": str(document.path), "line": line, "column": column}


declare(
    CheckResult,
    ("model", lambda result: joined(result.paths)),
    ("assumptions", lambda _result: []),
    ("findings", _findings),
)
declare(DiffResult, *("old", "new", "timing", "described", "changes", "findings"), ("impact", given("impact")))
declare(TimingChange, ("kind", "happening"), ("class", "kind"), "object", ("values", "differences"))
declare(
    ModelChange,
    "kind",
    ("class", "class_name"),
    ("object", "qualified_name"),
    *("feature", "old", "new"),
    ("old_location", lambda change: _place(change.old_element, change.feature)),
    ("new_location", lambda change: _place(change.new_element, change.feature)),
)
declare(InfoResult, (ALSO, lambda result: asdict(result.summary)))
declare(
    MigrationResult,
    ("model", lambda result: joined(file.path for file in result.files)),
    ("from", lambda result: ", ".join(dict.fromkeys(file.version for file in result.files if file.version))),
    ("to", "version"),
    *("files", "changes", "findings"),
)
declare(MigratedFile, ("file", "path"), ("version", lambda file: file.version or None), "target", "state")
declare(
    MigrationChange,
    ("kind", lambda change: _KINDS.get(change.kind, change.kind.replace(" ", "_"))),
    ("step", lambda change: change.step or None),
    *("message", "detail", "object"),
    ("file", "location.path"),
    ("line", "location.line"),
    ("column", "location.column"),
)
declare(
    RulesResult,
    (
        "rules",
        list_of(
            *("rules", "id", "severity", "effect"),
            ("profile", lambda rule: profile_name(rule.id)),
            *("title", "rationale", "remedy"),
        ),
    ),
)
