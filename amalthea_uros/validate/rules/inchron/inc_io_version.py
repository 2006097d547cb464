"""Unsupported AMALTHEA version."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule

#: The versions that am2inc supports.
VERSIONS = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0")


def _check(element: Amalthea, context: Context) -> Iterator[str | Downgraded]:
    document = element.document
    if document is not None and document.file_version not in VERSIONS:
        message = f"{spelled(document.file_version)} is not supported by am2inc"
        yield Downgraded(message) if document.migrated_from is None else message


RULE = ModelRule(
    id="INC-IO-VERSION",
    title="unsupported AMALTHEA version",
    severity=Severity.ERROR,
    target=Amalthea,
    check=_check,
    rationale="am2inc reads other versions with the metamodel of 3.2.0. It refuses nearly all files before 0.9.7, and those of other "
    "versions only if they use what 3.2.0 does not have, which INC-IO-FEATURE reports (warning).",
    remedy="Migrate the model to 1.2.0, 2.0.0, 2.1.0, 2.2.0, 3.0.0, 3.1.0, 3.2.0 or 3.3.0.",
    fails="",
    passes="<swModel/>",
    example_version="0.9.0",
    is_about_files=True,
)
